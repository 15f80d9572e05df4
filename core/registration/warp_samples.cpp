#include "core/registration/warp_samples.hpp"

#include <algorithm>
#include <cmath>

#include "core/registration/chain_measures.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMostSamples = 3000, kMostTargets = 4000;
constexpr double kAlongside = 0.1;  // weight of a reading across its plane, against that along its normal
constexpr double kOwned = 1.2;      // of the reach: a target so near to a sample is its patch's
constexpr double kBeside = 1.5;     // of the reach: the nearest target of a surface that is shown is nearer
constexpr double kOff = 0.75;       // of the spacing: what sampling a curved surface leaves

Point3f unit(const Normal16& n) noexcept {
  return {static_cast<float>(n.x) / 16384, static_cast<float>(n.y) / 16384, static_cast<float>(n.z) / 16384};
}

}  // namespace

WarpSamples::WarpSamples(Warp& warp) noexcept : w_(warp) {
  const RegistrationState& s = w_.s;
  count_ = std::min(kMostSamples, s.model.size());
  take_targets();
  w_.room.facing.fill(1);
}

void WarpSamples::take_targets() noexcept {
  RegistrationState& s = w_.s;
  WarpRoom& room = w_.room;
  const auto normal_reach = static_cast<float>(2 * working_reach(s));
  // Every n-th point is enough.
  const std::size_t step = (s.base_count + kMostTargets - 1) / kMostTargets;
  for (std::size_t j = 0; j < s.base_count; j += step) {
    if ((s.base_taken[j] & 2) != 0) continue;  // another instance's
    float square = 0;
    const std::uint32_t k = s.working_grid.nearest(s.base[j], normal_reach, square);
    if (k == PointGrid::kNone) continue;
    room.targets[targets_] = s.base[j];
    room.owner[targets_] = kNoOwner;
    room.target_normals[targets_++] = s.working_normals[k];
  }
  s.work += s.base_count / std::max<std::size_t>(1, step) * work::kNearest;
  const double thinned =
      static_cast<double>(s.model.size()) / static_cast<double>(std::max<std::size_t>(1, count_));
  reach_ =
      std::max(s.model.spacing() * std::sqrt(thinned), s.base_spacing * std::sqrt(static_cast<double>(step)));
  if (!room.target_grid.build(room.targets.first(targets_), 2 * reach_)) targets_ = 0;
}

void WarpSamples::place() noexcept {
  WarpRoom& room = w_.room;
  for (std::size_t p = 0; p < room.patches.count; ++p) room.fast[p] = FastTransform(room.pose[p]);
  for (std::size_t k = 0; k < count_; ++k) {
    const Placed sample = placed(k, room.fast[patch_of(k)]);
    room.places[k] = sample.at;
    room.normals[k] = sample.normal;
  }
}

void WarpSamples::find_owners() noexcept {
  WarpRoom& room = w_.room;
  static_cast<void>(room.sample_grid.build(room.places.first(count_), 2 * reach_));
  for (std::size_t j = 0; j < targets_; ++j) {
    const Point3f n = unit(room.target_normals[j]);
    float square = 0;
    const std::uint32_t k = room.sample_grid.nearest_if(
        room.targets[j], static_cast<float>(kOwned * reach_), square, [&](std::uint32_t sample) noexcept {
          const std::size_t p = patch_of(sample);
          return room.settled[p] && room.facing[p] * dot(n, room.normals[sample]) > kAlike;
        });
    room.owner[j] = k == PointGrid::kNone ? kNoOwner : static_cast<std::uint8_t>(patch_of(k));
  }
  w_.s.work += (count_ + targets_) * work::kNearest;
}

void WarpSamples::free_targets(const PatchSet& patches) noexcept {
  for (std::size_t j = 0; j < targets_; ++j)
    if (w_.room.owner[j] != kNoOwner && patches.has(w_.room.owner[j])) w_.room.owner[j] = kNoOwner;
}

bool WarpSamples::shows(const Placed& sample, std::uint32_t target) const noexcept {
  const Point3f& q = w_.room.targets[target];
  const Point3f apart = {q.x - sample.at.x, q.y - sample.at.y, q.z - sample.at.z};
  const auto beside = static_cast<float>(kBeside * reach_);
  return std::fabs(dot(apart, sample.normal)) < static_cast<float>(kOff * w_.s.spacing) &&
         dot(apart, apart) < beside * beside;
}

bool WarpSamples::may_be_seen(const Placed& sample) const noexcept {
  if (!w_.s.one_view) return true;
  const Point3f eye = to_point(w_.s.eye);
  return dot(sample.normal, {eye.x - sample.at.x, eye.y - sample.at.y, eye.z - sample.at.z}) > 0;
}

void WarpSamples::count_close() noexcept {
  WarpRoom& room = w_.room;
  room.asked.fill(0);
  room.close.fill(0);
  for (std::size_t k = 0; k < count_; ++k) {
    const std::size_t p = patch_of(k);
    const Placed sample = {room.places[k], room.normals[k]};
    if (!may_be_seen(sample)) continue;
    ++room.asked[p];
    float square = 0;
    const std::uint32_t target =
        target_of(sample, kBeside * reach_, kMuchAlike, room.facing[p], square,
                  [&](std::uint8_t owner) noexcept { return room.near[p].has(owner); });
    room.close[p] += target != PointGrid::kNone && shows(sample, target) ? 1U : 0U;
  }
  w_.s.work += count_ * work::kNearest;
}

void WarpSamples::find_facing(const PatchSet& patches) noexcept {
  WarpRoom& room = w_.room;
  patches.for_each([&](std::size_t p) { room.facing[p] = -1; });
  count_close();
  const std::array<std::uint32_t, kMaxPatches> inwards = room.close;
  patches.for_each([&](std::size_t p) { room.facing[p] = 1; });
  count_close();
  patches.for_each([&](std::size_t p) {
    if (inwards[p] <= room.close[p]) return;
    room.facing[p] = -1;
    room.close[p] = inwards[p];
  });
}

void add_reading(const WarpSamples& samples, const Point3f& place, std::uint32_t target, float square,
                 double gate, const Vector3& centre, Symmetric6& a, Vector6& b) noexcept {
  const WarpRoom& room = samples.room();
  const double left = std::max(0.0, 1 - static_cast<double>(square) / (gate * gate)), weight = left * left;
  const Vector3 at = to_vector(place), normal = to_vector(unit(room.target_normals[target]));
  const Vector3 arm = at - centre, gap = to_vector(room.targets[target]) - at;
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

}  // namespace pliant
