// The model points that poses are tried with, as arrays: many are posed side by side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/fast_transform.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

class ProbePoints {
 public:
  static constexpr std::size_t kBlock = 32;
  static constexpr float kFacing = 0.1736F * 0.1736F;  ///< cos² 80°: points seen more aslant do not count

  /// A block of points in the camera's frame.
  struct Posed {
    std::array<float, kBlock> x, y, z, nx, ny, nz;
    std::array<float, kBlock> facing;      ///< normal · point, negative towards the camera
    std::array<std::int32_t, kBlock> ask;  ///< 1: faces the camera by more than kFacing
  };

  /// Room for the first `count` points of a model.
  void lay_out(Workspace& workspace, std::size_t count) noexcept;
  void start(const ModelView& model) noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  /// Of the model, metres.
  [[nodiscard]] const Vector3& centre() const noexcept { return centre_; }
  [[nodiscard]] double radius() const noexcept { return radius_; }

  /// Poses the block of points from `first`, a multiple of kBlock.
  void pose_block(const FastTransform& pose, std::size_t first, Posed& out) const noexcept;

  /// visit(point, normal, normal · point) for those of the first `count` points, a multiple of kBlock or all,
  /// that face the camera under `pose` (camera <- model); returns how many.
  template <typename Visit>
  std::size_t visit_facing(const FastTransform& pose, std::size_t count, Visit&& visit) const noexcept {
    Posed posed;
    std::size_t facing = 0;
    for (std::size_t first = 0; first < count && first < count_; first += kBlock) {
      pose_block(pose, first, posed);
      for (std::size_t k = 0; k < kBlock; ++k) {
        if (posed.ask[k] == 0) continue;
        ++facing;
        visit(Point3f{posed.x[k], posed.y[k], posed.z[k]}, Point3f{posed.nx[k], posed.ny[k], posed.nz[k]},
              posed.facing[k]);
      }
    }
    return facing;
  }

 private:
  std::span<float> x_, y_, z_, nx_, ny_, nz_;  // whole blocks; what fills the last one has no normal
  std::size_t count_ = 0;
  Vector3 centre_ = Vector3::Zero();
  double radius_ = 0;
};

}  // namespace pliant
