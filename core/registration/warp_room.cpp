#include "core/registration/warp_room.hpp"

namespace pliant {

void WarpRoom::lay_out(Workspace& workspace, std::size_t model_points, std::size_t scene_points) noexcept {
  places = workspace.take<Point3f>(model_points);
  normals = workspace.take<Point3f>(model_points);
  targets = workspace.take<Point3f>(scene_points);
  target_normals = workspace.take<Normal16>(scene_points);
  owner = workspace.take<std::uint8_t>(scene_points);
  sample_grid.lay_out(workspace, model_points);
  target_grid.lay_out(workspace, scene_points);
}

void WarpRoom::start(const ModelView& model) noexcept {
  patches.start(model);
  for (std::size_t p = 0; p < patches.count; ++p) {
    PatchSet around;
    around.add(p);
    for (int ring = 0; ring < 3; ++ring) {
      const PatchSet inner = around;
      inner.for_each(
          [&](std::size_t q) { patches.neighbours[q].for_each([&](std::size_t t) { around.add(t); }); });
    }
    near[p] = around;
  }
}

}  // namespace pliant
