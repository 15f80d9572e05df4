#include "core/capture/standstill.hpp"

#include <algorithm>

namespace pliant {

namespace {

constexpr std::size_t kPoints = 16;  // of a view

}  // namespace

void Standstill::add(const RigidTransform& pose) noexcept {
  poses_[count_ % kViews] = pose;
  ++count_;
}

double Standstill::share(std::span<const ViewPoint> points, const RigidTransform& pose) const noexcept {
  const std::size_t views = std::min(count_, kViews), step = points.size() / kPoints + 1;
  const RigidTransform model_from_camera = pose.inverse();
  std::uint32_t looked = 0, alike = 0;
  for (std::size_t k = 0; k < views; ++k) {
    const RigidTransform then_from_now = poses_[k] * model_from_camera;
    for (std::size_t i = 0; i < points.size(); i += step) {
      const Vector3 now = Vector3(points[i].x, points[i].y, points[i].z) / kUnitsPerMetre;
      const Vector3 then = then_from_now * now;
      if (!(then.z() > 0)) continue;
      const double x = then.x() / then.z() - now.x() / now.z(), y = then.y() / then.z() - now.y() / now.z();
      ++looked;
      alike += x * x + y * y < kAlike * kAlike ? 1U : 0U;
    }
  }
  return looked > 0 ? static_cast<double>(alike) / looked : 1;
}

}  // namespace pliant
