#include "core/capture/coverage.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

constexpr double kTan22 = 0.41421356;  // of 22.5°
constexpr double kSin20 = 0.3420201, kSin50 = 0.7660444;

/// Of the direction (x, y) from the object to the camera; front is -y, right is +x.
int sector_of(double x, double y) noexcept {
  const double ax = std::fabs(x), ay = std::fabs(y);
  if (ax <= kTan22 * ay) return y < 0 ? 0 : 4;
  if (ay <= kTan22 * ax) return x > 0 ? 2 : 6;
  if (x > 0) return y < 0 ? 1 : 3;
  return y < 0 ? 7 : 5;
}

}  // namespace

void Coverage::add(const RigidTransform& pose, std::uint32_t times) noexcept {
  const Vector3 camera = pose.inverse().translation;
  const double distance = camera.norm();
  if (!(distance > 0)) return;
  const double sine = camera.z() / distance;
  const int height = sine < kSin20 ? 0 : sine < kSin50 ? 1 : 2;
  views_[row_major(height, kSectors, sector_of(camera.x(), camera.y()))] += times;
}

bool Coverage::seen(int sector) const noexcept {
  std::uint32_t sum = 0;
  for (int h = 0; h < kHeights; ++h) sum += views(sector, h);
  return sum >= kEnoughViews;
}

int Coverage::sectors_seen() const noexcept {
  int count = 0;
  for (int s = 0; s < kSectors; ++s) count += seen(s) ? 1 : 0;
  return count;
}

int Coverage::usual_height() const noexcept {
  int usual = 0;
  std::uint32_t most = 0;
  for (int h = 0; h < kHeights; ++h) {
    std::uint32_t sum = 0;
    for (int s = 0; s < kSectors; ++s) sum += views(s, h);
    if (sum > most) {
      most = sum;
      usual = h;
    }
  }
  return usual;
}

bool Coverage::seen_from_above() const noexcept {
  std::uint32_t sum = 0;
  for (int s = 0; s < kSectors; ++s) sum += views(s, 1) + views(s, 2);
  return sum >= kEnoughViews;
}

}  // namespace pliant
