#include "drivers/simulated/still_mesh.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "drivers/simulated/staging.hpp"

namespace pliant {

namespace {

using namespace simulated;

class StillMesh final : public Actor {
 public:
  explicit StillMesh(Geometry mesh) {
    mesh_ = std::move(mesh);
    vertex_part_.assign(mesh_.vertices.size(), 0);
    Vector3 low(1e9, 1e9, 1e9), high(-1e9, -1e9, -1e9);
    for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
      low = low.cwiseMin(rest(i));
      high = high.cwiseMax(rest(i));
    }
    place_ = Vector3(-0.5 * (low.x() + high.x()), -0.5 * (low.y() + high.y()), -low.z());
    height_ = high.z() - low.z();
  }
  [[nodiscard]] double height() const { return height_; }

  void move(double /*phase*/, ActorState& state, std::span<Vector3> vertices) const override {
    state.parts[0] = RigidTransform();
    state.parts[0].translation = place_;
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = rest(i) + place_;
  }

 private:
  Vector3 place_ = Vector3::Zero();  // onto the table, over the origin
  double height_ = 0;
};

}  // namespace

Result<std::unique_ptr<SimulatedSource>> open_still_mesh(Geometry mesh, std::string_view text) {
  const Result<Options> options = parse_options("cushion" + std::string(text));
  if (!options) return options.error();
  if (mesh.triangles.empty() || mesh.normals.size() != mesh.vertices.size())
    return Error{ErrorKind::bad_input, "a mesh with triangles and normals is wanted"};
  auto actor = std::make_unique<StillMesh>(std::move(mesh));
  const View view{33, 0.75, 0.5 * actor->height()};
  return stage_source(*options, {std::move(actor), view});
}

}  // namespace pliant
