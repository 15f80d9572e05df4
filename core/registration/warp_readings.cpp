#include "core/registration/warp_readings.hpp"

#include <algorithm>

#include "core/detect/fast_transform.hpp"
#include "core/registration/chain_measures.hpp"

namespace pliant {

namespace {

constexpr double kAlongside = 0.1;  // weight of a reading across its plane, against that along its normal
constexpr std::size_t kMostFree = 2500;  // points that ask, and scene points that do, in a round
constexpr float kSameSide = 0.5F;        // cosine of the angle between normals that may belong together

/// A reading of a patch: the point `at` should come to `to`, by all of `weight` along `normal` and a little
/// across.
void add_reading(const Vector3& at, const Vector3& to, const Vector3& normal, double weight,
                 const Vector3& centre, Symmetric6& a, Vector6& b) noexcept {
  const Vector3 arm = at - centre, gap = to - at;
  Vector6 row;
  row.head<3>() = arm.cross(normal);
  row.tail<3>() = normal;
  const double residual = gap.dot(normal);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      a.at(i, j) += weight * row[static_cast<int>(i)] * row[static_cast<int>(j)];
    b[static_cast<int>(i)] += weight * residual * row[static_cast<int>(i)];
  }
  const double across = kAlongside * weight;
  a.add_point_spring(across, arm);
  b.head<3>() += across * arm.cross(gap);
  b.tail<3>() += across * gap;
}

double tukey(double square, double limit) noexcept {
  const double left = 1 - square / (limit * limit);
  return left > 0 ? left * left : 0;
}

Point3f unit(const Normal16& n) noexcept {
  return {static_cast<float>(n.x) / 16384, static_cast<float>(n.y) / 16384, static_cast<float>(n.z) / 16384};
}

void add_pair(Warp& w, std::size_t k, std::size_t j, double gate) noexcept {
  const std::size_t p = w.room.patches.patch_of[w.room.free[k]];
  const Vector3 at = to_vector(w.room.places[k]), to = to_vector(w.room.targets[j]);
  const Vector3 normal = to_vector(unit(w.room.target_normals[j]));
  const double weight = tukey((to - at).squaredNorm(), gate);
  ++w.room.readings[p];
  add_reading(at, to, normal, weight, w.room.pose[p] * w.room.patches.centres[p], w.room.system.own(p),
              w.room.system.force(p));
}

}  // namespace

std::size_t place_free(Warp& w) noexcept {
  const PatchTables& patches = w.room.patches;
  std::size_t count = 0;
  for (std::size_t p = 0; p < patches.count; ++p) w.room.fast[p] = FastTransform(w.room.pose[p]);
  for (std::size_t i = 0; i < w.s.model.size() && count < kMostFree; ++i) {
    const std::size_t p = patches.patch_of[i];
    if (w.room.rigid[p]) continue;
    w.room.free[count] = static_cast<std::uint16_t>(i);
    w.room.places[count] = w.room.fast[p].point(w.s.model.positions()[i]);
    w.room.normals[count++] = w.room.fast[p].direction(w.s.model.normals()[i]);
  }
  return count;
}

std::size_t near_scene(Warp& w, std::size_t free_count, double reach) noexcept {
  RegistrationState& s = w.s;
  static_cast<void>(w.room.free_grid.build(w.room.places.first(free_count), 0.5 * reach));
  const auto normal_reach = static_cast<float>(2 * working_reach(s));
  std::size_t count = 0;
  for (std::size_t j = 0; j < s.base_count; ++j) {
    if (s.base_taken[j] != 0) continue;
    float square = 0;
    if (w.room.free_grid.nearest(s.base[j], static_cast<float>(reach), square) == PointGrid::kNone) continue;
    const std::uint32_t k = s.working_grid.nearest(s.base[j], normal_reach, square);
    if (k == PointGrid::kNone) continue;
    w.room.targets[count] = s.base[j];
    w.room.target_normals[count++] = s.working_normals[k];
  }
  // Every n-th of them is enough.
  const std::size_t step = (count + kMostFree - 1) / kMostFree;
  std::size_t kept = 0;
  for (std::size_t j = 0; step > 1 && j < count; j += step, ++kept) {
    w.room.targets[kept] = w.room.targets[j];
    w.room.target_normals[kept] = w.room.target_normals[j];
  }
  return step > 1 ? kept : count;
}

void add_pulls(Warp& w, std::size_t pulls, double weight, double limit) noexcept {
  for (std::size_t k = 0; k < pulls; ++k) {
    const std::size_t match = w.room.pulls[k];
    const std::size_t p = w.room.patches.patch_of[w.s.matches[match].model];
    const Vector3 at = w.room.pose[p] * to_vector(w.s.posed[match].model);
    const Vector3 gap = to_vector(w.s.posed[match].scene) - at;
    const Vector3 arm = at - w.room.pose[p] * w.room.patches.centres[p];
    const double k_pull = weight * tukey(gap.squaredNorm(), limit);
    w.room.system.own(p).add_point_spring(k_pull, arm);
    w.room.system.force(p).head<3>() += k_pull * arm.cross(gap);
    w.room.system.force(p).tail<3>() += k_pull * gap;
  }
}

void add_readings(Warp& w, std::size_t free_count, std::size_t target_count, double gate) noexcept {
  w.room.readings.fill(0);
  const auto reach = static_cast<float>(gate);
  for (std::size_t k = 0; k < free_count; ++k) {
    const Point3f& n = w.room.normals[k];
    float square = 0;
    const std::uint32_t j = w.room.target_grid.nearest_if(
        w.room.places[k], reach, square,
        [&](std::uint32_t t) { return dot(unit(w.room.target_normals[t]), n) > kSameSide; });
    if (j != PointGrid::kNone) add_pair(w, k, j, gate);
  }
  static_cast<void>(
      w.room.free_grid.build(w.room.places.first(free_count), std::max(0.5 * gate, w.s.spacing)));
  for (std::size_t j = 0; j < target_count; ++j) {
    const Point3f n = unit(w.room.target_normals[j]);
    float square = 0;
    const std::uint32_t k =
        w.room.free_grid.nearest_if(w.room.targets[j], reach, square,
                                    [&](std::uint32_t f) { return dot(w.room.normals[f], n) > kSameSide; });
    if (k != PointGrid::kNone) add_pair(w, k, j, gate);
  }
}

}  // namespace pliant
