#include "core/registration/warp_room.hpp"

namespace pliant {

void WarpRoom::lay_out(Workspace& workspace, std::size_t model_points, std::size_t scene_points) noexcept {
  tables.lay_out(workspace, model_points);
  patches.lay_out(workspace, model_points);
  queue = workspace.take<std::uint16_t>(model_points);
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
  tables.start(model);
  patches.start(tables, queue);
}

}  // namespace pliant
