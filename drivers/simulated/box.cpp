#include <algorithm>

#include "drivers/simulated/actor.hpp"
#include "drivers/simulated/implicit.hpp"
#include "drivers/simulated/motion.hpp"
#include "drivers/simulated/surface_nets.hpp"

namespace pliant::simulated {

namespace {

double box(const Vector3& p) {
  double all = rounded_box(p, {0, 0, 0}, {0.120, 0.085, 0.065}, 0.008);
  const Vector3 cut = Vector3(-1, -0.9, 0.8).normalized();
  all = std::max(all, half_space(p, {-0.120, -0.040, 0.035}, cut));
  all = smooth_union(all, rounded_box(p, {0.050, 0.020, 0.083}, {0.048, 0.036, 0.026}, 0.006), 0.004);
  all = smooth_union(all, ellipsoid(p, {0.045, -0.085, -0.012}, {0.036, 0.024, 0.030}), 0.004);
  return smooth_difference(all, capsule(p, {-0.075, 0.095, 0.074}, {-0.030, 0.020, 0.074}, 0.020), 0.004);
}

class Box final : public Actor {
 public:
  Box() {
    mesh_ = mesh_of(&box, {-0.14, -0.13, -0.09}, {0.14, 0.11, 0.13}, 0.0050);
    hand_ = open_hand_mesh();
    vertex_part_.assign(mesh_.vertices.size(), 0);
  }

  void move(double phase, ActorState& state, std::span<Vector3> vertices) const override {
    // Lifted and turned, hidden in part, carried out to the right, brought back.
    const double out = there_and_back(phase, 102, 186, 200, 284);
    const double turn =
        40 * there_and_back(phase, 8, 50, 60, 105) + 34 * there_and_back(phase, 112, 170, 216, 276);
    const double tilt = 14 * there_and_back(phase, 20, 50, 62, 96);
    const double lifted = there_and_back(phase, 4, 36, 240, 280);
    RigidTransform& base = state.parts[0];
    base.rotation = rotation_about(Vector3::UnitZ(), kDegree * (-22 + turn)) *
                    rotation_about(Vector3(0.6, 0.8, 0), kDegree * tilt);
    base.translation = {0.02 - 0.05 * there_and_back(phase, 20, 50, 70, 100) + 0.62 * out, -0.02,
                        0.066 + 0.07 * lifted};
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = base * rest(i);
    state.hand.rotation = rotation_about(Vector3::UnitY(), kDegree * 8);
    state.hand.translation = {0.80 - 0.82 * there_and_back(phase, 24, 62, 72, 110), -0.26, 0.19};
  }
};

}  // namespace

std::unique_ptr<Actor> make_box() {
  return std::make_unique<Box>();
}

}  // namespace pliant::simulated
