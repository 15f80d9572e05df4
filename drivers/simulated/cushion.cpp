#include "drivers/simulated/actor.hpp"
#include "drivers/simulated/implicit.hpp"
#include "drivers/simulated/motion.hpp"
#include "drivers/simulated/surface_nets.hpp"

namespace pliant::simulated {

namespace {

const Vector3 kHalf(0.165, 0.125, 0.052);  ///< metres
const Vector3 kDent(0.015, -0.015, 0);     ///< its middle, model frame
constexpr double kDentRadius = 0.110;      ///< metres
constexpr double kDeepest = 0.035;         ///< metres

double cushion(const Vector3& p) {
  double all = pillow(p, kHalf);
  all = smooth_union(all, ellipsoid(p, {-0.105, 0.060, 0.036}, {0.044, 0.028, 0.034}), 0.012);  // lump
  all = smooth_union(all, sphere(p, {0.108, 0.066, 0.046}, 0.024), 0.008);                      // knob
  all =
      smooth_union(all, capsule(p, {-0.120, -0.085, 0.024}, {-0.020, -0.098, 0.028}, 0.014), 0.010);  // ridge
  all = smooth_union(all, capsule(p, {0.135, -0.080, 0.014}, {0.150, 0.010, 0.018}, 0.017), 0.010);   // seam
  return smooth_difference(all, capsule(p, {-0.150, -0.030, 0.052}, {-0.095, -0.045, 0.056}, 0.017), 0.010);
}

/// Share of the dent's depth by which a point at rest goes down: all of it at the dent's middle on top,
/// nothing beyond its radius or on the lower side.
double share_of_dent(const Vector3& p) {
  const double dx = p.x() - kDent.x();
  const double dy = p.y() - kDent.y();
  const double t = 1 - (dx * dx + dy * dy) / (kDentRadius * kDentRadius);
  return t > 0 ? t * t * smooth_step((p.z() + 0.030) / 0.060) : 0;
}

/// Depth of the dent, metres: a deep press and a shallower, quicker one.
double depth_of_dent(double phase) {
  return kDeepest * there_and_back(phase, 45, 80, 125, 160) +
         0.6 * kDeepest * there_and_back(phase, 203, 225, 235, 255);
}

/// Height of the fist above the cushion's top, metres, and how far it stays off to the right.
double lift_of_fist(double phase) {
  return 0.30 * (1 - there_and_back(phase, 10, 45, 160, 192) - there_and_back(phase, 170, 203, 255, 283));
}

class Cushion final : public Actor {
 public:
  Cushion() {
    mesh_ = mesh_of(&cushion, {-0.19, -0.15, -0.07}, {0.19, 0.15, 0.09}, 0.0057);
    hand_ = fist_mesh();
    for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
      share_.push_back(share_of_dent(rest(i)));
      vertex_part_.push_back(share_.back() > 0 ? std::int8_t{-1} : std::int8_t{0});
    }
  }

  void move(double phase, ActorState& state, std::span<Vector3> vertices) const override {
    RigidTransform& base = state.parts[0];
    base.rotation = rotation_about(
        Vector3::UnitZ(), kDegree * (12 + 38 * sway(phase, kRound, 1) - 16 * sway(phase, kRound, 3)));
    base.translation = {0.050 * sway(phase, kRound, 2) - 0.030 * sway(phase, kRound, 1),
                        -0.040 * sway(phase, kRound, 1), 0.052};
    const double depth = depth_of_dent(phase);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      Vector3 p = rest(i);
      p.z() -= depth * share_[i];
      vertices[i] = base * p;
    }
    // The fist rests on the dent and turns with the cushion only in place: its arm keeps its direction.
    const double lift = lift_of_fist(phase);
    const Vector3 contact(kDent.x(), kDent.y(), kHalf.z() - depth);
    state.hand.rotation = Matrix3::Identity();
    state.hand.translation = base * contact + Vector3(1.1 * lift, 0.3 * lift, lift + 0.002);
  }

 private:
  std::vector<double> share_;
};

}  // namespace

std::unique_ptr<Actor> make_cushion() {
  return std::make_unique<Cushion>();
}

}  // namespace pliant::simulated
