// A started surface with memory of its own, and what its tests measure by.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/camera/surface.hpp"
#include "tests/core/synthetic.hpp"

namespace pliant::synthetic {

/// A started surface with memory of its own.
struct Observed {
  explicit Observed(const Intrinsics& camera = small_camera(), Kernels kernels = Kernels::automatic,
                    const SensorDescription& sensor = {})
      : memory(needed(camera)) {
    surface.lay_out(memory.get(), camera);
    surface.start(camera, sensor, kernels);
  }
  static std::size_t needed(const Intrinsics& camera) {
    Workspace measure;
    Surface surface;
    surface.lay_out(measure, camera);
    return measure.used();
  }
  void build(Picture& picture) { surface.build(picture.frame(), {0, 0, surface.width(), surface.height()}); }

  OwnedWorkspace memory;
  Surface surface;
};

inline double degrees(const Normal16& n, const Vector3& truth) {
  const Vector3 m = Vector3(n.x, n.y, n.z).normalized();
  return std::acos(std::clamp(m.dot(truth.normalized()), -1.0, 1.0)) * 180 / 3.14159265;
}

}  // namespace pliant::synthetic
