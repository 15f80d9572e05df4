#include "core/capture/background.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/detect/symmetric_eigen.hpp"
#include "core/memory/row_major.hpp"

namespace pliant {

namespace {

constexpr std::int32_t kReach = 1 << 15;   // 1/16 mm: farther points are not used
constexpr double kNormalSpan = 0.02;       // metres that a candidate's normal is taken over
constexpr std::uint32_t kLeastShare = 25;  // a plane holds at least one of so many lattice points
constexpr int kRefinements = 3;
constexpr double kSurelyBackground = 2;  // times the least extent

/// 4 σ and at least 6 mm: real tables are not flat, and stereo cameras are noisier over them than over
/// objects.
std::int32_t tolerance(std::int32_t sigma) noexcept {
  return std::max(4 * sigma, 6 * kUnitsPerMillimetre);
}

std::int32_t rounded(double x) noexcept {
  return static_cast<std::int32_t>(std::floor(x + 0.5));
}

}  // namespace

void BackgroundPlanes::lay_out(Workspace& workspace, const Intrinsics& camera) noexcept {
  across_ = camera.width / kStep;
  down_ = camera.height / kStep;
  const auto points = static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_);
  lattice_ = workspace.take<LatticePoint>(points);
  queue_ = workspace.take<std::int32_t>(points);
}

void BackgroundPlanes::start(const Surface& surface, double least_extent) noexcept {
  least_extent_ = least_extent;
  normal_span_ = surface.pixel_span(kNormalSpan).span;
  count_ = 0;
  age_ = 0;
}

void BackgroundPlanes::gather(const Surface& surface) noexcept {
  used_ = 0;
  for (int y = 0; y < down_; ++y)
    for (int x = 0; x < across_; ++x) {
      const int u = x * kStep + kStep / 2, v = y * kStep + kStep / 2;
      LatticePoint& point = lattice_[row_major(y, across_, x)];
      point = LatticePoint();
      const std::uint16_t z8 = surface.depth_at(u, v);
      if (z8 == 0 || 2 * z8 >= kReach) continue;
      point.p = surface.vertex(u, v, z8);
      point.sigma = static_cast<std::int16_t>(surface.sigma(point.p.z));
      point.usable = std::abs(point.p.x) < kReach && std::abs(point.p.y) < kReach;
      used_ += point.usable ? 1U : 0U;
    }
}

bool BackgroundPlanes::lies_on(const LatticePoint& point, const BackgroundPlane& plane) const noexcept {
  return point.usable && point.plane < 0 && std::abs(plane.height(point.p)) < tolerance(point.sigma);
}

std::uint32_t BackgroundPlanes::votes(const BackgroundPlane& plane) const noexcept {
  std::uint32_t count = 0;
  for (const LatticePoint& point : lattice_) count += lies_on(point, plane) ? 1U : 0U;
  return count;
}

std::int32_t BackgroundPlanes::connected_extent(const BackgroundPlane& plane) noexcept {
  for (LatticePoint& point : lattice_) point.visited = !lies_on(point, plane);
  std::int32_t largest = 0;
  for (std::size_t seed = 0; seed < lattice_.size(); ++seed) {
    if (lattice_[seed].visited) continue;
    lattice_[seed].visited = true;
    IntPoint low = lattice_[seed].p, high = low;
    std::size_t end = 0;
    queue_[end++] = static_cast<std::int32_t>(seed);
    for (std::size_t at = 0; at < end; ++at) {
      const int x = queue_[at] % across_, y = queue_[at] / across_;
      const IntPoint& p = lattice_[static_cast<std::size_t>(queue_[at])].p;
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      const auto look = [&](int nx, int ny) {
        if (nx < 0 || ny < 0 || nx >= across_ || ny >= down_) return;
        LatticePoint& next = lattice_[row_major(ny, across_, nx)];
        if (next.visited) return;
        next.visited = true;
        queue_[end++] = ny * across_ + nx;
      };
      look(x - 1, y);
      look(x + 1, y);
      look(x, y - 1);
      look(x, y + 1);
    }
    largest = std::max({largest, high.x - low.x, high.y - low.y, high.z - low.z});
  }
  return largest;
}

bool BackgroundPlanes::search(const Surface& surface, BackgroundPlane& best) const noexcept {
  best.points = 0;
  for (std::size_t k = 0; k < kCandidates; ++k) {
    // Spread over the picture row by row.
    const std::size_t at = ((2 * k + 1) * lattice_.size()) / (2 * kCandidates);
    const LatticePoint& point = lattice_[at];
    if (!point.usable || point.plane >= 0) continue;
    Normal16 n;
    const int u = static_cast<int>(at) % across_ * kStep + kStep / 2;
    const int v = static_cast<int>(at) / across_ * kStep + kStep / 2;
    const std::uint16_t z8 = surface.depth_at(u, v);
    if (!surface.normal(u, v, Surface::normal_step(z8, PixelSpan{normal_span_}), n)) continue;
    BackgroundPlane plane{{n.x, n.y, n.z}, 0, 0};
    plane.offset = plane.height(point.p);
    plane.points = votes(plane);
    if (plane.points > best.points) best = plane;
  }
  return static_cast<std::size_t>(best.points) * kLeastShare >= used_;
}

bool BackgroundPlanes::fit(BackgroundPlane& plane) noexcept {
  for (int round = 0; round < kRefinements; ++round) {
    // Coordinates below 2^15, products below 2^30, sums of 2^15 points below 2^45.
    std::int64_t n = 0, s[3] = {0, 0, 0}, m[6] = {0, 0, 0, 0, 0, 0};
    for (const LatticePoint& point : lattice_) {
      if (!lies_on(point, plane)) continue;
      const std::int64_t x = point.p.x, y = point.p.y, z = point.p.z;
      ++n;
      s[0] += x;
      s[1] += y;
      s[2] += z;
      m[0] += x * x;
      m[1] += x * y;
      m[2] += x * z;
      m[3] += y * y;
      m[4] += y * z;
      m[5] += z * z;
    }
    if (n < 16 || static_cast<std::size_t>(n) * kLeastShare < used_) return false;
    const auto count = static_cast<double>(n);
    const Vector3 mean(static_cast<double>(s[0]) / count, static_cast<double>(s[1]) / count,
                       static_cast<double>(s[2]) / count);
    Matrix3 spread;
    spread << static_cast<double>(m[0]), static_cast<double>(m[1]), static_cast<double>(m[2]),
        static_cast<double>(m[1]), static_cast<double>(m[3]), static_cast<double>(m[4]),
        static_cast<double>(m[2]), static_cast<double>(m[4]), static_cast<double>(m[5]);
    spread = spread / count - mean * mean.transpose();
    const SymmetricEigen eigen = symmetric_eigen(spread);
    Vector3 normal = eigen.vectors.col(0);
    if (normal.dot(mean) > 0) normal = -normal;
    plane.normal = {rounded(normal.x() * 16384), rounded(normal.y() * 16384), rounded(normal.z() * 16384)};
    plane.offset = rounded(normal.dot(mean));
    plane.points = static_cast<std::uint32_t>(n);
    plane.spread = rounded(std::sqrt(std::max(0.0, eigen.values[0])));
  }
  const std::int32_t extent = connected_extent(plane);
  if (extent < least_extent_ * kUnitsPerMetre) return false;
  // Behind the top of a box or a cushion lies the table; behind the background next to nothing; behind a wide
  // table part of the floor. What cuts through the top of a cushion and what stands level with it is as wide,
  // with the whole table behind.
  std::uint32_t behind = 0;
  for (const LatticePoint& point : lattice_)
    behind += point.usable && plane.height(point.p) < -2 * tolerance(point.sigma) ? 1U : 0U;
  if (extent >= kSurelyBackground * least_extent_ * kUnitsPerMetre) return behind < 4 * plane.points;
  return 2 * behind < plane.points;
}

void BackgroundPlanes::assign(const BackgroundPlane& plane, std::int8_t index) noexcept {
  for (LatticePoint& point : lattice_)
    if (point.usable && point.plane < 0 && plane.height(point.p) < tolerance(point.sigma))
      point.plane = index;  // also what lies behind it
}

void BackgroundPlanes::update(const Surface& surface) noexcept {
  gather(surface);
  const std::size_t before = count_;
  count_ = 0;
  for (std::size_t k = 0; k < before; ++k) {
    BackgroundPlane plane = planes_[k];
    if (!fit(plane)) continue;
    planes_[count_] = plane;
    assign(plane, static_cast<std::int8_t>(count_++));
  }
  if (count_ < before || age_ == 0)
    while (count_ < kMost) {
      BackgroundPlane plane;
      if (used_ == 0 || !search(surface, plane) || !fit(plane)) break;
      planes_[count_] = plane;
      assign(plane, static_cast<std::int8_t>(count_++));
    }
  age_ = (age_ + 1) % kSearchEvery;
}

}  // namespace pliant
