#include <algorithm>

#include "drivers/simulated/actor.hpp"
#include "drivers/simulated/implicit.hpp"
#include "drivers/simulated/motion.hpp"
#include "drivers/simulated/surface_nets.hpp"

namespace pliant::simulated {

namespace {

// Model frame: x to the figure's left (the camera's right), y away from the camera, z up.
const Vector3 kWaist(0, 0, 0.012);
const Vector3 kWaistAxis = Vector3(0.30, 0.45, 0.841130).normalized();
const Vector3 kElbow(0.148, -0.002, 0.072);
const Vector3 kHandEnd(0.168, -0.022, 0.160);
const Vector3 kElbowAxis = Vector3(0.25, 0.94, 0.232379).normalized();

double figure(const Vector3& p) {
  double legs = capsule(p, {-0.050, 0, -0.150}, {-0.046, 0, -0.04}, 0.040);
  legs = std::min(legs, capsule(p, {0.052, 0.004, -0.150}, {0.046, 0, -0.04}, 0.040));
  legs = smooth_union(legs, ellipsoid(p, {0, 0, -0.028}, {0.092, 0.064, 0.048}), 0.02);
  legs = smooth_union(legs, capsule(p, {-0.056, -0.062, -0.168}, {-0.052, 0, -0.166}, 0.022), 0.012);
  legs = smooth_union(legs, capsule(p, {0.070, -0.054, -0.168}, {0.054, 0.004, -0.166}, 0.022), 0.012);
  legs = smooth_union(legs, rounded_box(p, {-0.092, -0.012, -0.055}, {0.014, 0.022, 0.026}, 0.006), 0.006);
  double body = ellipsoid(p, {0, 0, 0.064}, {0.080, 0.056, 0.076});
  body = smooth_union(body, sphere(p, {0.018, -0.044, 0.042}, 0.036), 0.014);  // belly
  body = smooth_union(body, rounded_box(p, {-0.01, 0.058, 0.078}, {0.044, 0.022, 0.044}, 0.010), 0.008);
  double head = ellipsoid(p, {0, -0.004, 0.160}, {0.046, 0.048, 0.050});
  head = smooth_union(head, capsule(p, {0.002, -0.046, 0.156}, {0.006, -0.066, 0.150}, 0.011), 0.006);
  head = smooth_union(head, rounded_box(p, {0.006, -0.040, 0.186}, {0.034, 0.036, 0.006}, 0.005), 0.006);
  head = smooth_union(head, sphere(p, {-0.040, 0.020, 0.192}, 0.020), 0.006);
  const double right_arm =
      smooth_union(capsule(p, {-0.070, 0, 0.108}, {-0.138, -0.010, 0.088}, 0.024),
                   capsule(p, {-0.138, -0.010, 0.088}, {-0.120, -0.075, 0.074}, 0.023), 0.01);
  const double left_arm = smooth_union(
      capsule(p, {0.070, 0, 0.108}, kElbow, 0.024),
      smooth_union(capsule(p, kElbow, kHandEnd, 0.022), ellipsoid(p, kHandEnd, {0.034, 0.026, 0.036}), 0.01),
      0.008);
  double all = smooth_union(legs, body, 0.02);
  all = smooth_union(all, head, 0.014);
  return smooth_union(smooth_union(all, right_arm, 0.014), left_arm, 0.014);
}

/// How far a point follows the joint above it: 0 not at all, 1 wholly, between in a band of 24 to 26 mm.
double above_waist(const Vector3& p) {
  return smooth_step((p.z() - kWaist.z() + 0.012) / 0.024);
}
double beyond_elbow(const Vector3& p) {
  if (p.x() < 0.105) return 0;
  const Vector3 along = (kHandEnd - kElbow).normalized();
  return smooth_step(((p - kElbow).dot(along) + 0.002) / 0.026);
}

class Figure final : public Actor {
 public:
  Figure() {
    mesh_ = mesh_of(&figure, {-0.20, -0.12, -0.21}, {0.23, 0.12, 0.23}, 0.0060);
    hand_ = open_hand_mesh();
    parts_ = 3;
    for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
      const double waist = above_waist(rest(i));
      const double elbow = beyond_elbow(rest(i));
      weights_.push_back({waist, elbow});
      const bool blended = (waist > 0 && waist < 1) || (elbow > 0 && elbow < 1);
      vertex_part_.push_back(blended ? std::int8_t{-1}
                                     : static_cast<std::int8_t>((waist > 0 ? 1 : 0) + (elbow > 0 ? 1 : 0)));
    }
  }

  void move(double phase, ActorState& state, std::span<Vector3> vertices) const override {
    RigidTransform& base = state.parts[0];
    base.rotation = rotation_about(Vector3::UnitZ(), kDegree * (-14 + 30 * sway(phase, kRound, 1)));
    base.translation = {0.045 * sway(phase, kRound, 1), 0.030 * sway(phase, kRound, 3), 0.190};
    const double waist = kDegree * 19 * (sway(phase, kRound, 1) - 1.2 * sway(phase, kRound, 2));
    const double elbow = kDegree * (-55 * there_and_back(phase, 30, 75, 95, 140) +
                                    30 * there_and_back(phase, 160, 200, 215, 255));
    const RigidTransform whole_waist = hinge(kWaist, kWaistAxis, waist);
    const RigidTransform whole_elbow = hinge(kElbow, kElbowAxis, elbow);
    state.parts[1] = base * whole_waist;
    state.parts[2] = state.parts[1] * whole_elbow;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Weights& w = weights_[i];
      Vector3 p = rest(i);
      if (w.elbow > 0) p = (w.elbow < 1 ? hinge(kElbow, kElbowAxis, w.elbow * elbow) : whole_elbow) * p;
      if (w.waist > 0) p = (w.waist < 1 ? hinge(kWaist, kWaistAxis, w.waist * waist) : whole_waist) * p;
      vertices[i] = base * p;
    }
    // A hand passes between the camera and the legs once a round.
    state.hand.rotation = Matrix3::Identity();
    state.hand.translation = {0.75 - 0.85 * there_and_back(phase, 205, 240, 245, 280), -0.22, 0.10};
  }

 private:
  struct Weights {
    double waist, elbow;
  };
  std::vector<Weights> weights_;
};

}  // namespace

std::unique_ptr<Actor> make_figure() {
  return std::make_unique<Figure>();
}

}  // namespace pliant::simulated
