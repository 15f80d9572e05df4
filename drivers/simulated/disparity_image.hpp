// Draws triangles into an image of disparity, the quantity in which a structured-light sensor measures.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera/intrinsics.hpp"
#include "core/geometry/rigid_transform.hpp"

namespace pliant::simulated {

/// Disparity d = kFocalBaseline / z in pixels of the full 640-pixel-wide image, whatever the image's own
/// size: PrimeSense sensors match at that size with a base line of 75 mm and a focal length of 570 pixels.
inline constexpr double kFocalBaseline = 570.0 * 0.075;
/// Fixed point: 20 fraction bits. Nearest z drawn is 0.1 m, hence below 2^29.
inline constexpr int kDisparityBits = 20;
inline constexpr double kNearest = 0.1;  ///< metres

/// Disparity is affine over the picture of a plane, so a triangle is drawn by additions alone and the nearer
/// of two surfaces is the greater number.
class DisparityImage {
 public:
  explicit DisparityImage(const Intrinsics& camera);

  /// Nothing anywhere.
  void clear();
  void copy_from(const DisparityImage& other) { pixels_ = other.pixels_; }
  /// Draws the triangles that face the camera, vertices in the camera's frame, and sets `facing` (when not
  /// empty) to 1 for each of their vertices. Triangles with a vertex nearer than kNearest are left out.
  void draw(std::span<const Vector3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles,
            std::span<std::uint8_t> facing);
  /// Draws the plane normal·p = offset, camera frame, where `covers` says so for a point on it.
  void draw_plane(const Vector3& normal, double offset, bool (*covers)(const Vector3& in_camera, const void*),
                  const void* context);
  /// The surface at the vertex's pixel is at most `tolerance` metres before it.
  [[nodiscard]] bool sees(const Vector3& vertex, double tolerance) const;

  [[nodiscard]] std::span<const std::int32_t> pixels() const { return pixels_; }
  [[nodiscard]] int width() const { return camera_.width; }
  [[nodiscard]] int height() const { return camera_.height; }

 private:
  struct Corner {
    double u, v, d;  ///< pixels, pixels, disparity in fixed-point units
  };
  void draw_triangle(const Corner& a, const Corner& b, const Corner& c);

  Intrinsics camera_;
  std::vector<std::int32_t> pixels_;  ///< 0 = nothing
  std::vector<Corner> corners_;
};

}  // namespace pliant::simulated
