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
  std::array<bool, kMaxPatches> rigid{};          ///< nearly all of it is explained by regions
  std::array<std::uint32_t, kMaxPatches> hold{};  ///< points that its home explains
  std::array<std::array<std::uint32_t, limits::kMaxRegions>, kMaxPatches> counts{};
  std::array<std::uint32_t, kMaxPatches> borne{};  ///< matches that bear its first pose out

  std::array<bool, kMaxPatches> settled{};   ///< the scene bears it out where it is
  std::array<bool, kMaxPatches> active{};    ///< settled, or beside what is: takes readings
  std::array<bool, kMaxPatches> fixed{};     ///< stays with its region
  std::array<PatchSet, kMaxPatches> near{};  ///< itself, and the patches up to three borders away
  std::array<float, kMaxPatches> facing{};   ///< 1, or −1 where the scene's normals there point inwards
  std::array<std::uint32_t, kMaxPatches> asked{}, close{};  ///< its samples, and those that the scene shows
  std::array<RigidTransform, kMaxPatches> kept, best;       ///< poses before a trial, and of the best one

  std::span<Point3f> places, normals;  ///< of the samples, scene frame
  std::span<Point3f> targets;          ///< points of the scene, and which patch's samples they lie on
  std::span<Normal16> target_normals;
  std::span<std::uint8_t> owner;
  PointGrid sample_grid, target_grid;

  void lay_out(Workspace& workspace, std::size_t model_points, std::size_t scene_points) noexcept;
  void start(const ModelView& model) noexcept;
};

}  // namespace pliant
