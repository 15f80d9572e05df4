#include "core/registration/cloud_warp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/detect/fast_transform.hpp"
#include "core/registration/chain_measures.hpp"

namespace pliant {

namespace {

constexpr double kFirstGate = 0.25, kLastSpacings = 2.5;  // of the model's radius; of the spacing
constexpr double kHold = 1.0;  // of a patch's points: what its region's pull is worth where it explains it
constexpr double kAlongside = 0.1;  // weight of a reading across its plane, against that along its normal
constexpr std::size_t kMostFree = 2500;  // points that ask, and scene points that do, in a round
constexpr double kAround = 0.25;         // of the model's radius: what bears a match out lies so near
constexpr std::size_t kMostAround = 96;
constexpr double kFrameError = 0.25;  // radians that a local frame is off
constexpr std::uint32_t kFewestAgree = 3;
constexpr double kAgreeShare = 0.3;
constexpr float kSameSide = 0.5F;  // cosine of the angle between normals that may belong together

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

/// What the rounds work with.
struct Warp {
  RegistrationState& s;
  InstanceBuffers& buffers;
  WarpRoom& room;
};

void find_homes(Warp& w) noexcept {
  const PatchTables& patches = w.room.patches;
  for (std::size_t p = 0; p < patches.count; ++p) {
    w.room.counts[p].fill(0);
    w.room.home[p] = -1;
  }
  for (std::size_t i = 0; i < w.s.model.size(); ++i)
    if (w.buffers.labels[i] >= 0)
      ++w.room.counts[patches.patch_of[i]][static_cast<std::size_t>(w.buffers.labels[i])];
  for (std::size_t p = 0; p < patches.count; ++p) {
    const auto& counts = w.room.counts[p];
    const auto most = std::max_element(counts.begin(), counts.end());
    const bool some = *most > 0;
    w.room.home[p] = some ? static_cast<std::int8_t>(most - counts.begin()) : std::int8_t{-1};
    std::uint32_t explained = 0;
    for (const std::uint32_t c : counts) explained += c;
    w.room.rigid[p] = 10 * explained >= 9 * patches.sizes[p];
    w.room.hold[p] = *most;
  }
  // What no region explains starts with the nearest one that has a home.
  for (std::size_t sweep = 0; sweep < patches.count; ++sweep) {
    bool changed = false;
    for (std::size_t k = 0; k < patches.border_count; ++k) {
      std::int8_t &a = w.room.home[patches.borders[k].a], &b = w.room.home[patches.borders[k].b];
      if ((a < 0) == (b < 0)) continue;
      (a < 0 ? a : b) = std::max(a, b);
      changed = true;
    }
    if (!changed) break;
  }
  for (std::size_t p = 0; p < patches.count; ++p) {
    if (w.room.home[p] < 0) w.room.home[p] = 0;
    w.room.pose[p] = w.buffers.regions[static_cast<std::size_t>(w.room.home[p])].transform;
  }
}

/// Matches of points that may move, each borne out by its neighbours: the pose that its local frames propose
/// brings most of the matches around it to their scene points too. A limb that bends is rigid over so short a
/// way. Writes their numbers to room.pulls; returns how many.
std::size_t find_pulls(Warp& w) noexcept {
  RegistrationState& s = w.s;
  const std::size_t count = std::min(s.posed_count, w.room.places.size());
  for (std::size_t k = 0; k < count; ++k) w.room.places[k] = s.posed[k].model;
  const double around = kAround * s.model.radius();
  static_cast<void>(w.room.free_grid.build(w.room.places.first(count), 0.5 * around));
  for (std::size_t p = 0; p < w.room.patches.count; ++p) w.room.borne[p] = 0;
  std::size_t pulls = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t p = w.room.patches.patch_of[s.matches[k].model];
    if (w.room.rigid[p]) continue;
    const RigidTransform pose = pose_from_frames(s.posed[k]);
    const Vector3 own = to_vector(s.posed[k].model);
    std::uint32_t near = 0, agree = 0;
    w.room.free_grid.visit_within(s.posed[k].model, static_cast<float>(around), kMostAround,
                                  [&](std::uint32_t j, const Point3f& m, float /*square*/) {
                                    if (j == k) return;
                                    ++near;
                                    const double limit =
                                        match_tolerance(s) + kFrameError * (to_vector(m) - own).norm();
                                    const Vector3 gap = pose * to_vector(m) - to_vector(s.posed[j].scene);
                                    agree += gap.squaredNorm() < limit * limit ? 1U : 0U;
                                  });
    if (agree < kFewestAgree || static_cast<double>(agree) < kAgreeShare * near) continue;
    w.room.pulls[pulls++] = static_cast<std::uint16_t>(k);
    if (agree <= w.room.borne[p]) continue;
    w.room.borne[p] = agree;
    w.room.pose[p] = pose;
  }
  // Patches without a match start as a neighbour that has one.
  for (std::size_t sweep = 0; sweep < w.room.patches.count; ++sweep) {
    bool changed = false;
    for (std::size_t k = 0; k < w.room.patches.border_count; ++k) {
      const PatchBorder& border = w.room.patches.borders[k];
      for (const auto& [from, to] : {std::pair{border.a, border.b}, std::pair{border.b, border.a}}) {
        if (w.room.rigid[to] || w.room.borne[to] != 0 || w.room.hold[to] != 0 || w.room.borne[from] == 0)
          continue;
        w.room.pose[to] = w.room.pose[from];
        w.room.borne[to] = 1;
        changed = true;
      }
    }
    if (!changed) break;
  }
  return pulls;
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

/// Places the points of patches that may move, at most kMostFree of them (the first points of the model are
/// spread evenly); returns how many.
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

/// The scene points near the free part, with the normals of the working cloud.
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

Point3f unit(const Normal16& n) noexcept {
  return {static_cast<float>(n.x) / 16384, static_cast<float>(n.y) / 16384, static_cast<float>(n.z) / 16384};
}

void add_pair(Warp& w, std::size_t k, std::size_t j, double gate) noexcept {
  const std::size_t p = w.room.patches.patch_of[w.room.free[k]];
  const Vector3 at = to_vector(w.room.places[k]), to = to_vector(w.room.targets[j]);
  const Vector3 normal = to_vector(unit(w.room.target_normals[j]));
  const double weight = tukey((to - at).squaredNorm(), gate);
  add_reading(at, to, normal, weight, w.room.pose[p] * w.room.patches.centres[p], w.room.system.own(p),
              w.room.system.force(p));
}

/// Readings of every free point, and of every scene point near the free part.
void add_readings(Warp& w, std::size_t free_count, std::size_t target_count, double gate) noexcept {
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

void add_springs(Warp& w, double stretch, double bend) noexcept {
  const PatchTables& patches = w.room.patches;
  for (std::size_t p = 0; p < patches.count; ++p) {
    const RigidTransform& region = w.buffers.regions[static_cast<std::size_t>(w.room.home[p])].transform;
    // A whole patch of a region stays; of another, what the region explains pulls it there.
    const double k = w.room.rigid[p] ? 100.0 * patches.sizes[p] : kHold * w.room.hold[p];
    if (k <= 0) continue;
    w.room.system.own(p).add_shift_spring(k);
    w.room.system.own(p).add_turn_spring(0.5 * k * patches.radius * patches.radius);
    w.room.system.force(p).tail<3>() +=
        k * (region * patches.centres[p] - w.room.pose[p] * patches.centres[p]);
    w.room.system.force(p).head<3>() +=
        0.5 * k * patches.radius * patches.radius * turn_between(region.rotation, w.room.pose[p].rotation);
  }
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    if (w.room.rigid[border.a] && w.room.rigid[border.b]) continue;
    const RigidTransform &a = w.room.pose[border.a], &b = w.room.pose[border.b];
    const Vector3 at_a = a * border.centre, at_b = b * border.centre;
    ElasticLink link;
    link.a = border.a;
    link.b = border.b;
    link.stretch = stretch * border.edges;
    link.bend = bend * border.edges;
    link.arm_a = at_a - a * patches.centres[border.a];
    link.arm_b = at_b - b * patches.centres[border.b];
    w.room.system.add_link(link, at_a - at_b, turn_between(a.rotation, b.rotation));
  }
}

}  // namespace

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

void warp_cloud(RegistrationState& s, const CloudWarpSettings& settings, InstanceBuffers& buffers) noexcept {
  Warp w{s, buffers, s.warp};
  find_homes(w);
  const std::size_t pulls = find_pulls(w);
  std::size_t free_count = place_free(w);
  const double first = kFirstGate * s.model.radius(), last = kLastSpacings * s.spacing;
  if (free_count > 0) {
    const std::size_t targets = near_scene(w, free_count, 2 * first);
    static_cast<void>(w.room.target_grid.build(w.room.targets.first(targets), 2 * s.spacing));
    // A border edge gives by `strain` of its length, or bends by that angle, where a reading is off by a
    // quarter of the spacing: what sampling leaves.
    const double noise = 0.25 * s.spacing, strain = 0.1 + 0.4 * settings.material;
    const double stretch = noise * noise / (strain * strain * s.model.spacing() * s.model.spacing());
    const double bend = noise * noise / (strain * strain);
    for (int round = 0; round < settings.rounds; ++round) {
      // From stiff, which brings large pieces near, to soft.
      const double done = static_cast<double>(round) / std::max(1, settings.rounds - 1);
      const double gate = first + (last - first) * std::min(1.0, 1.3 * done);
      const double stiff = 1 + 15 * (1 - done) * (1 - done);
      w.room.system.clear(w.room.patches.count);
      add_readings(w, free_count, targets, gate);
      // What descriptors say is good to a keypoint's distance.
      if (done < 0.7) add_pulls(w, pulls, 4 * (1 - done), 2 * first * (1 - done) + 2 * match_tolerance(s));
      add_springs(w, stiff * stretch, stiff * bend);
      if (!w.room.system.solve(settings.iterations)) break;
      for (std::size_t p = 0; p < w.room.patches.count; ++p) {
        const Vector6& x = w.room.system.motion(p);
        if (w.room.rigid[p] || !(x.squaredNorm() < 1.0)) continue;  // also for not-a-number
        w.room.pose[p] = motion_about(x, w.room.pose[p] * w.room.patches.centres[p]) * w.room.pose[p];
        w.room.pose[p].rotation = orthonormalised(w.room.pose[p].rotation);
      }
      free_count = place_free(w);
    }
  }
  for (std::size_t p = 0; p < w.room.patches.count; ++p) w.room.fast[p] = FastTransform(w.room.pose[p]);
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    if (buffers.labels[i] >= 0) {
      const RigidTransform& region = buffers.regions[static_cast<std::size_t>(buffers.labels[i])].transform;
      buffers.positions[i] = FastTransform(region).point(s.model.positions()[i]);
      continue;
    }
    const PointBlend& blend = w.room.patches.blend[i];
    Point3f sum;
    for (std::size_t j = 0; j < 4 && blend.weight[j] != 0; ++j) {
      const Point3f p = w.room.fast[blend.patch[j]].point(s.model.positions()[i]);
      const float weight = static_cast<float>(blend.weight[j]) / (1 << PointBlend::kShift);
      sum = {sum.x + weight * p.x, sum.y + weight * p.y, sum.z + weight * p.z};
    }
    buffers.positions[i] = sum;
  }
}

}  // namespace pliant
