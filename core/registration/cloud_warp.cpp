#include "core/registration/cloud_warp.hpp"

#include <algorithm>

#include "core/detect/fast_transform.hpp"
#include "core/registration/warp_growth.hpp"
#include "core/registration/warp_starts.hpp"

namespace pliant {

namespace {

constexpr double kByChance = 1.5;  // of the spacing: farther from where the warp found it

/// Takes points from regions that explained them by chance.
void doubt_labels(Warp& w) noexcept {
  RegistrationState& s = w.s;
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    const std::size_t p = w.room.patches.patch_of[i];
    if (w.buffers.labels[i] < 0 || w.room.fixed[p]) continue;
    const RigidTransform& region = w.buffers.regions[static_cast<std::size_t>(w.buffers.labels[i])].transform;
    const Vector3 point = to_vector(s.model.positions()[i]);
    if ((region * point - w.room.pose[p] * point).norm() > kByChance * s.spacing)
      w.buffers.labels[i] = kNotObserved;
  }
}

void place_points(Warp& w) noexcept {
  const PatchTables& patches = w.room.patches;
  for (std::size_t p = 0; p < patches.count; ++p) w.room.fast[p] = FastTransform(w.room.pose[p]);
  for (std::size_t i = 0; i < w.s.model.size(); ++i) {
    const Point3f& point = w.s.model.positions()[i];
    if (w.buffers.labels[i] >= 0) {
      const RigidTransform& region =
          w.buffers.regions[static_cast<std::size_t>(w.buffers.labels[i])].transform;
      w.buffers.positions[i] = FastTransform(region).point(point);
      continue;
    }
    const PointBlend& blend = patches.blend[i];
    Point3f sum;
    for (std::size_t j = 0; j < 4 && blend.weight[j] != 0; ++j) {
      const Point3f p = w.room.fast[blend.patch[j]].point(point);
      const float weight = static_cast<float>(blend.weight[j]) / (1 << PointBlend::kShift);
      sum = {sum.x + weight * p.x, sum.y + weight * p.y, sum.z + weight * p.z};
    }
    w.buffers.positions[i] = sum;
  }
}

}  // namespace

void warp_cloud(RegistrationState& s, InstanceBuffers& buffers) noexcept {
  Warp w{s, buffers, s.warp};
  find_homes(w);
  find_starts(w);
  const bool any_free = std::any_of(s.warp.rigid.begin(),
                                    s.warp.rigid.begin() + static_cast<std::ptrdiff_t>(s.warp.patches.count),
                                    [](bool rigid) { return !rigid; });
  if (any_free) {
    WarpSamples samples(w);
    if (samples.target_count() > 0) {
      const WarpStiffness stiffness = stiffness_of(s);
      grow_settled(samples, stiffness);
      relax_settled(samples, stiffness);
      doubt_labels(w);
    }
  }
  place_points(w);
}

}  // namespace pliant
