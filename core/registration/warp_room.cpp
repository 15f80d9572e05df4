#include "core/registration/warp_room.hpp"

namespace pliant {

void WarpRoom::lay_out(Workspace& workspace, std::size_t model_points, std::size_t scene_points) noexcept {
  pulls = workspace.take<std::uint16_t>(model_points);
  free = workspace.take<std::uint16_t>(model_points);
  places = workspace.take<Point3f>(model_points);
  normals = workspace.take<Point3f>(model_points);
  targets = workspace.take<Point3f>(scene_points);
  target_normals = workspace.take<Normal16>(scene_points);
  free_grid.lay_out(workspace, model_points);
  target_grid.lay_out(workspace, scene_points);
}

void WarpRoom::start(const ModelView& model) noexcept {
  patches.start(model);
}

}  // namespace pliant
