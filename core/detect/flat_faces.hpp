// The few planes nearest to oriented points: a box, a plate, a step.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

struct OrientedReading {
  Vector3 point, normal;  ///< the normal is zero where it is not known
};

class FlatFaces {
 public:
  static constexpr std::size_t kMost = 3;  ///< of a box, that one side shows
  /// The directions that most normals have, each with the plane of the readings that have it.
  void start(std::span<const OrientedReading> readings) noexcept;
  /// After start(): each the plane nearest to the readings that it is nearest to.
  void fit(std::span<const OrientedReading> readings) noexcept;
  /// One of the faces without the others.
  [[nodiscard]] FlatFaces alone(std::size_t face) const noexcept;
  /// A face that stands alone anew, as the plane nearest to all readings (at least four).
  void fit_alone(std::span<const OrientedReading> readings) noexcept;
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// From the nearest face, at most `most`.
  [[nodiscard]] double squared_distance(const Vector3& p, double most) const noexcept;

 private:
  struct Face {
    Vector3 normal;
    double offset = 0;
  };
  void fit_nearest(std::span<const OrientedReading> readings) noexcept;
  [[nodiscard]] std::size_t nearest(const Vector3& p) const noexcept;

  std::array<Face, kMost> faces_;
  std::size_t count_ = 0;
};

}  // namespace pliant
