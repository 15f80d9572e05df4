#include "core/detect/flat_faces.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/symmetric_eigen.hpp"

namespace pliant {

namespace {

constexpr int kRounds = 6;            // of telling each reading its face and fitting the faces anew
constexpr double kAlike = 0.9;        // cosine: what noise leaves of a face's normals
constexpr std::size_t kEvery = 4;     // reading is tried as a face's direction
constexpr double kLeastShare = 0.05;  // of the readings: fewer make no face

}  // namespace

void FlatFaces::start(std::span<const OrientedReading> readings) noexcept {
  // The direction that most normals have, that which most of the others have, and so on.
  count_ = 0;
  const auto taken = [&](const Vector3& normal) {
    return std::any_of(faces_.begin(), faces_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [&](const Face& face) { return face.normal.dot(normal) > kAlike; });
  };
  while (count_ < kMost) {
    std::size_t most = 0, best = 0;
    for (std::size_t k = 0; k < readings.size(); k += kEvery) {
      const Vector3& normal = readings[k].normal;
      if (normal.dot(normal) < 0.5 || taken(normal)) continue;
      std::size_t alike = 0;
      for (const OrientedReading& r : readings)
        alike += r.normal.dot(normal) > kAlike && !taken(r.normal) ? 1U : 0U;
      if (alike > most) {
        most = alike;
        best = k;
      }
    }
    if (static_cast<double>(most) <= kLeastShare * static_cast<double>(readings.size())) return;
    const Vector3 normal = readings[best].normal;
    double offset = 0;
    for (const OrientedReading& r : readings)
      if (r.normal.dot(normal) > kAlike && !taken(r.normal)) offset += r.point.dot(normal);
    faces_[count_++] = {normal, offset / static_cast<double>(most)};
  }
}

std::size_t FlatFaces::nearest(const Vector3& p) const noexcept {
  std::size_t best = 0;
  double least = 1e300;
  for (std::size_t k = 0; k < count_; ++k) {
    const double off = std::fabs(faces_[k].normal.dot(p) - faces_[k].offset);
    if (off < least) {
      least = off;
      best = k;
    }
  }
  return best;
}

void FlatFaces::fit(std::span<const OrientedReading> readings) noexcept {
  for (int round = 0; round < kRounds && count_ > 0; ++round) fit_nearest(readings);
}

FlatFaces FlatFaces::alone(std::size_t face) const noexcept {
  FlatFaces one;
  one.faces_[0] = faces_[face];
  one.count_ = 1;
  return one;
}

void FlatFaces::fit_alone(std::span<const OrientedReading> readings) noexcept {
  fit_nearest(readings);
}

void FlatFaces::fit_nearest(std::span<const OrientedReading> readings) noexcept {
  std::array<Vector3, kMost> sum;
  std::array<Matrix3, kMost> square;
  std::array<double, kMost> number{};
  sum.fill(Vector3::Zero());
  square.fill(Matrix3::Zero());
  for (const OrientedReading& r : readings) {
    const std::size_t k = nearest(r.point);
    sum[k] += r.point;
    square[k] += r.point * r.point.transpose();
    number[k] += 1;
  }
  for (std::size_t k = 0; k < count_; ++k) {
    if (number[k] < 4) continue;
    const Vector3 mean = sum[k] / number[k];
    const Vector3 normal = symmetric_eigen(square[k] / number[k] - mean * mean.transpose()).vectors.col(0);
    faces_[k] = {normal, normal.dot(mean)};
  }
}

double FlatFaces::squared_distance(const Vector3& p, double most) const noexcept {
  if (count_ == 0) return most * most;
  const Face& face = faces_[nearest(p)];
  const double off = face.normal.dot(p) - face.offset;
  return std::min(off * off, most * most);
}

}  // namespace pliant
