// Memory of the warp of a cloud.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/deform/elastic_system.hpp"
#include "core/detect/fast_transform.hpp"
#include "core/detect/point_grid.hpp"
#include "core/track/patches.hpp"

namespace pliant {

struct WarpRoom {
  PatchTables patches;
  ElasticSystem system;
  std::array<RigidTransform, kMaxPatches> pose;   ///< scene <- model
  std::array<FastTransform, kMaxPatches> fast{};  ///< the same
  std::array<std::int8_t, kMaxPatches> home{};    ///< region that it hangs on
  std::array<bool, kMaxPatches> rigid{};          ///< nearly all of it is explained by its home
  std::array<std::uint32_t, kMaxPatches> hold{};  ///< points that its home explains
  std::array<std::array<std::uint32_t, limits::kMaxRegions>, kMaxPatches> counts{};

  std::array<std::uint32_t, kMaxPatches> readings{};  ///< of this round

  std::array<std::uint32_t, kMaxPatches> borne{};  ///< matches that bear its first pose out

  std::span<std::uint16_t> pulls;  ///< numbers of matches that pull
  std::span<std::uint16_t> free;   ///< points of patches that may move, and where they are
  std::span<Point3f> places, normals;
  std::span<Point3f> targets;  ///< the scene around them
  std::span<Normal16> target_normals;
  PointGrid free_grid, target_grid;

  void lay_out(Workspace& workspace, std::size_t model_points, std::size_t scene_points) noexcept;
  void start(const ModelView& model) noexcept;
};

}  // namespace pliant
