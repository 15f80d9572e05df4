// The model in the integers that the frame path works on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/camera/surface.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"
#include "core/track/patch_points.hpp"

namespace pliant {

/// Points relative to the model's centre in 1/16 mm and outward normals in Q14, one array a coordinate.
/// |coordinate| <= 32000 (limits::kMaxModelHalfExtent).
struct ModelTables {
  std::size_t size = 0;
  Vector3 centre = Vector3::Zero();  ///< metres, model frame
  std::int32_t spacing = 0;          ///< 1/16 mm
  std::span<std::int16_t> x, y, z;
  std::span<std::int16_t> nx, ny, nz;
  PatchPoints by_patch;  ///< the same patch by patch
  const ModelView* model = nullptr;

  void lay_out(Workspace& workspace, std::size_t points) noexcept;
  void start(const ModelView& view) noexcept;
};

/// A rigid transform camera <- centred model in integers: rotation Q14, translation 1/16 mm.
/// Exact to 2^-15 of the distance from the centre, plus half a unit.
struct FixedPose {
  std::int32_t r[9] = {16384, 0, 0, 0, 16384, 0, 0, 0, 16384};
  std::int32_t t[3] = {0, 0, 0};

  FixedPose() noexcept = default;
  /// `pose` is camera <- model (not centred), metres; |translation| below 60 m.
  FixedPose(const RigidTransform& pose, const Vector3& centre) noexcept;

  /// Overflow bound: three products of 2^14 and 2^15 stay below 2^31.
  [[nodiscard]] IntPoint point(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept {
    return {((r[0] * x + r[1] * y + r[2] * z + 8192) >> 14) + t[0],
            ((r[3] * x + r[4] * y + r[5] * z + 8192) >> 14) + t[1],
            ((r[6] * x + r[7] * y + r[8] * z + 8192) >> 14) + t[2]};
  }
  /// Q14 in, Q14 out.
  [[nodiscard]] IntPoint direction(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept {
    return {(r[0] * x + r[1] * y + r[2] * z + 8192) >> 14, (r[3] * x + r[4] * y + r[5] * z + 8192) >> 14,
            (r[6] * x + r[7] * y + r[8] * z + 8192) >> 14};
  }
};

/// Depth of the model's centre under a pose (camera <- model), 1/16 mm.
[[nodiscard]] inline std::int32_t depth_of(const RigidTransform& pose, const Vector3& centre) noexcept {
  return static_cast<std::int32_t>((pose * centre).z() * kUnitsPerMetre);
}

/// Where points fall in the picture, in integers: focal lengths and centre in 1/8 pixel.
class Projector {
 public:
  void start(const Intrinsics& camera) noexcept;
  /// Nearest pixel. False behind or nearer than 50 mm, or farther than 8 m, or outside the picture.
  /// Overflow bound: |x| <= widest_x, so that its product with the focal length stays below 2^31. What is
  /// farther aside lies more than 2000 pixels from the principal point.
  [[nodiscard]] bool project(const IntPoint& p, int& u, int& v) const noexcept {
    if (p.z < 50 * kUnitsPerMillimetre || p.z > kFarthest || p.x > widest_x_ || p.x < -widest_x_ ||
        p.y > widest_y_ || p.y < -widest_y_)
      return false;
    u = (p.x * fx_ / p.z + cx_) >> 3;
    v = (p.y * fy_ / p.z + cy_) >> 3;
    return u >= 0 && u < width_ && v >= 0 && v < height_;
  }
  /// Where the point falls in 1/256 pixel, rounded as project() rounds, inside the picture or not. False
  /// nearer than 50 mm or beyond 8 m.
  [[nodiscard]] bool project_finely(const IntPoint& p, std::int32_t& u, std::int32_t& v) const noexcept {
    if (p.z < 50 * kUnitsPerMillimetre || p.z > kFarthest) return false;
    u = static_cast<std::int32_t>((static_cast<std::int64_t>(p.x) * fx_ * 32) / p.z) + cx_ * 32;
    v = static_cast<std::int32_t>((static_cast<std::int64_t>(p.y) * fy_ * 32) / p.z) + cy_ * 32;
    return true;
  }
  /// Pixels that `length` (1/16 mm) spans at depth z (1/16 mm), rounded up. Not before the camera counts as
  /// at its nearest, z = 1: what is tracked may be held to lie there. Overflow bound: |length| <= 2^17, since
  /// focal lengths are at most 10000 pixels.
  [[nodiscard]] int pixels(std::int32_t length, std::int32_t z) const noexcept {
    return static_cast<int>(
        static_cast<std::int64_t>(length) * fx_ / (8 * static_cast<std::int64_t>(std::max(z, 1))) + 1);
  }
  /// The length (1/16 mm) that `steps` 1/256 pixels span at depth z (1/16 mm), likewise.
  [[nodiscard]] std::int64_t length(std::int32_t steps, std::int32_t z) const noexcept {
    return static_cast<std::int64_t>(steps) * std::max(z, 1) / (static_cast<std::int64_t>(fx_) * 32);
  }

 private:
  static constexpr std::int32_t kFarthest = 128000;  // 8 m
  std::int32_t fx_ = 0, fy_ = 0, cx_ = 0, cy_ = 0;
  std::int32_t widest_x_ = 0, widest_y_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace pliant
