#include "drivers/simulated/actor.hpp"
#include "drivers/simulated/implicit.hpp"
#include "drivers/simulated/surface_nets.hpp"

namespace pliant::simulated {

namespace {

double fist(const Vector3& p) {
  const double knuckles = ellipsoid(p, {0, 0, 0.042}, {0.046, 0.040, 0.042});
  const double thumb = capsule(p, {-0.040, -0.020, 0.050}, {-0.012, -0.040, 0.035}, 0.012);
  const double arm = capsule(p, {0.045, 0.010, 0.075}, {0.36, 0.10, 0.38}, 0.034);
  return smooth_union(smooth_union(knuckles, thumb, 0.010), arm, 0.03);
}

double open_hand(const Vector3& p) {
  double all = ellipsoid(p, {0, 0, 0}, {0.052, 0.018, 0.046});
  for (int finger = 0; finger < 4; ++finger) {
    const double z = -0.033 + 0.022 * finger;
    const double reach = finger == 0 ? 0.095 : 0.12 - 0.006 * (finger - 2) * (finger - 2);
    all = smooth_union(all, capsule(p, {-0.035, 0, z}, {-reach, -0.008, 1.15 * z}, 0.0095), 0.008);
  }
  all = smooth_union(all, capsule(p, {0.010, -0.005, 0.035}, {-0.045, -0.02, 0.085}, 0.011), 0.012);
  return smooth_union(all, capsule(p, {0.05, 0, 0}, {0.50, 0.03, -0.08}, 0.032), 0.03);
}

}  // namespace

Geometry fist_mesh() {
  return mesh_of(&fist, {-0.07, -0.07, -0.02}, {0.42, 0.16, 0.44}, 0.009);
}

Geometry open_hand_mesh() {
  return mesh_of(&open_hand, {-0.15, -0.06, -0.13}, {0.56, 0.09, 0.12}, 0.008);
}

}  // namespace pliant::simulated
