// Correspondences as arrays, so that many are compared with one pose or one of them side by side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/fast_transform.hpp"
#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// Places of correspondences in the model and in the scene, metres, one array a coordinate. Single precision
/// is good to a micrometre at ten metres.
struct MatchLanes {
  std::span<float> mx, my, mz, sx, sy, sz;

  void put(std::size_t i, const Point3f& model, const Point3f& scene) const noexcept {
    mx[i] = model.x;
    my[i] = model.y;
    mz[i] = model.z;
    sx[i] = scene.x;
    sy[i] = scene.y;
    sz[i] = scene.z;
  }

  /// hits[i] = 1 where match i keeps its distance to match `seed` by `tolerance`, else 0; returns their sum.
  std::uint32_t consistent_with(std::size_t seed, float tolerance,
                                std::span<std::int32_t> hits) const noexcept;
  /// How many of the first `count` matches keep their distance to match `seed` by `tolerance` and are brought
  /// by `pose` (scene <- model) nearer to their scene point than `tolerance` and `growth` of their distance
  /// from the seed.
  [[nodiscard]] std::uint32_t count_agreeing(std::size_t seed, const FastTransform& pose, float tolerance,
                                             float growth, std::size_t count) const noexcept;
  /// hits[i] = 1 where `pose` brings match i nearer to its scene point than `tolerance` and `growth` of its
  /// distance from `around` (model), else 0.
  void explained_by(const FastTransform& pose, const Point3f& around, float tolerance, float growth,
                    std::span<std::int32_t> hits) const noexcept;
};

}  // namespace pliant
