#include "core/detect/grouping.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace pliant {

namespace {

double squared(const Vector3& v) noexcept {
  return v.dot(v);
}

/// The eigenvector of the largest eigenvalue of a symmetric 4×4 matrix: Jacobi rotations, eight sweeps.
void largest_eigenvector4(double (&a)[4][4], double (&vector)[4]) noexcept {
  double v[4][4] = {};
  for (int i = 0; i < 4; ++i) v[i][i] = 1;
  for (int sweep = 0; sweep < 8; ++sweep)
    for (int p = 0; p < 3; ++p)
      for (int q = p + 1; q < 4; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta < 0 ? -1.0 : 1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1);
        const double s = t * c;
        for (int k = 0; k < 4; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 4; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
        }
        for (int k = 0; k < 4; ++k) {
          const double kp = v[k][p], kq = v[k][q];
          v[k][p] = c * kp - s * kq;
          v[k][q] = s * kp + c * kq;
        }
      }
  int best = 0;
  for (int i = 1; i < 4; ++i)
    if (a[i][i] > a[best][best]) best = i;
  for (int i = 0; i < 4; ++i) vector[i] = v[i][best];
}

}  // namespace

RigidTransform pose_from_frames(const PosedMatch& match) noexcept {
  const Matrix3 rotation = axes_of(match.scene_frame).transpose() * axes_of(match.model_frame);
  return {rotation, to_vector(match.scene) - rotation * to_vector(match.model)};
}

bool rigid_fit(std::span<const PosedMatch> matches, std::span<const std::uint32_t> members,
               RigidTransform& transform) noexcept {
  if (members.size() < 3) return false;
  Vector3 a = Vector3::Zero(), b = Vector3::Zero();
  for (const std::uint32_t i : members) {
    a += to_vector(matches[i].model);
    b += to_vector(matches[i].scene);
  }
  a /= static_cast<double>(members.size());
  b /= static_cast<double>(members.size());
  Matrix3 s = Matrix3::Zero(), spread = Matrix3::Zero();
  for (const std::uint32_t i : members) {
    const Vector3 m = to_vector(matches[i].model) - a;
    s += m * (to_vector(matches[i].scene) - b).transpose();
    spread += m * m.transpose();
  }
  // On a line the spread's second invariant vanishes against the square of its trace.
  const double trace = spread.trace();
  const double second = 0.5 * (trace * trace - (spread * spread).trace());
  if (!(second > 1e-4 * trace * trace)) return false;
  double n[4][4] = {{s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0)},
                    {0, s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2)},
                    {0, 0, -s(0, 0) + s(1, 1) - s(2, 2), s(1, 2) + s(2, 1)},
                    {0, 0, 0, -s(0, 0) - s(1, 1) + s(2, 2)}};
  for (int i = 1; i < 4; ++i)
    for (int j = 0; j < i; ++j) n[i][j] = n[j][i];
  double q[4];
  largest_eigenvector4(n, q);
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(norm > 0)) return false;
  transform.rotation = rotation_from_quaternion({q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm});
  transform.translation = b - transform.rotation * a;
  return true;
}

void Grouping::lay_out(Workspace& workspace, std::size_t matches) noexcept {
  order_ = workspace.take<std::uint32_t>(matches);
  members_ = workspace.take<std::uint32_t>(matches + 1);
  seeds_ = workspace.take<Seed>(1024);
  bits_ = workspace.take<std::uint64_t>(kMostMembers * kMostMembers / 64);
  for (std::span<float>* array : {&lanes_.mx, &lanes_.my, &lanes_.mz, &lanes_.sx, &lanes_.sy, &lanes_.sz})
    *array = workspace.take<float>(matches);
  hits_ = workspace.take<std::int32_t>(matches);
}

std::size_t Grouping::gather(std::size_t matches, const RigidTransform& pose, const Point3f& around,
                             double tolerance, double growth) noexcept {
  lanes_.explained_by(FastTransform(pose), around, static_cast<float>(tolerance), static_cast<float>(growth),
                      hits_.first(matches));
  return collect_hits(matches);
}

std::size_t Grouping::collect_hits(std::size_t matches) noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < matches; ++i) {
    members_[count] = static_cast<std::uint32_t>(i);
    count += static_cast<std::size_t>(hits_[i]);
  }
  return count;
}

std::size_t Grouping::drop_inconsistent(std::span<const PosedMatch> matches, std::size_t count,
                                        double tolerance) noexcept {
  if (count > kMostMembers) {
    // The best matches speak for all.
    std::partial_sort(
        members_.begin(), members_.begin() + kMostMembers,
        members_.begin() + static_cast<std::ptrdiff_t>(count), [&](std::uint32_t a, std::uint32_t b) {
          return matches[a].quality != matches[b].quality ? matches[a].quality > matches[b].quality : a < b;
        });
    count = kMostMembers;
  }
  constexpr std::size_t kWords = kMostMembers / 64;
  float room[6][kMostMembers] = {};
  const MatchLanes members = {room[0], room[1], room[2], room[3], room[4], room[5]};
  for (std::size_t i = 0; i < count; ++i)
    members.put(i, matches[members_[i]].model, matches[members_[i]].scene);
  std::int32_t hits[kMostMembers] = {};
  for (std::size_t i = 0; i < count; ++i) {
    members.consistent_with(i, static_cast<float>(tolerance), std::span(hits).first(count));
    hits[i] = 0;
    for (std::size_t w = 0; w < kWords; ++w) {
      std::uint64_t word = 0;
      for (std::size_t b = 0; b < 64; ++b) word |= static_cast<std::uint64_t>(hits[64 * w + b]) << b;
      bits_[i * kWords + w] = word;
    }
  }
  // Those consistent with fewer than half of the group go; twice, as the group is then smaller.
  std::uint64_t alive[kWords] = {};
  for (std::size_t i = 0; i < count; ++i) alive[i / 64] |= std::uint64_t{1} << (i % 64);
  for (int pass = 0; pass < 2; ++pass) {
    std::uint64_t next[kWords] = {};
    int living = 0;
    for (const std::uint64_t word : alive) living += std::popcount(word);
    for (std::size_t i = 0; i < count; ++i) {
      if ((alive[i / 64] >> (i % 64) & 1) == 0) continue;
      int degree = 1;
      for (std::size_t w = 0; w < kWords; ++w) degree += std::popcount(bits_[i * kWords + w] & alive[w]);
      if (2 * degree >= living) next[i / 64] |= std::uint64_t{1} << (i % 64);
    }
    for (std::size_t w = 0; w < kWords; ++w) alive[w] = next[w];
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i)
    if ((alive[i / 64] >> (i % 64) & 1) != 0) members_[kept++] = members_[i];
  return kept;
}

std::size_t Grouping::group(std::span<const PosedMatch> all, const GroupingSettings& settings, double radius,
                            std::span<MatchGroup> groups) noexcept {
  const std::span<const PosedMatch> matches = all.first(std::min(all.size(), order_.size()));
  if (matches.size() < 3 || groups.empty()) return 0;
  for (std::size_t i = 0; i < matches.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
  const std::size_t seeds =
      std::min({static_cast<std::size_t>(settings.seeds), matches.size(), seeds_.size()});
  std::partial_sort(
      order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(seeds),
      order_.begin() + static_cast<std::ptrdiff_t>(matches.size()), [&](std::uint32_t a, std::uint32_t b) {
        return matches[a].quality != matches[b].quality ? matches[a].quality > matches[b].quality : a < b;
      });
  for (std::size_t i = 0; i < matches.size(); ++i) lanes_.put(i, matches[i].model, matches[i].scene);
  const auto tolerance = static_cast<float>(settings.tolerance);
  const auto growth = static_cast<float>(settings.frame_tolerance);
  for (std::size_t k = 0; k < seeds; ++k) {
    const std::uint32_t seed = order_[k];
    seeds_[k] = {seed, settings.use_frames
                           ? lanes_.count_agreeing(seed, FastTransform(pose_from_frames(matches[seed])),
                                                   tolerance, growth, matches.size())
                           : lanes_.consistent_with(seed, tolerance, hits_.first(matches.size()))};
  }
  std::sort(seeds_.begin(), seeds_.begin() + static_cast<std::ptrdiff_t>(seeds),
            [](const Seed& a, const Seed& b) {
              return a.count != b.count ? a.count > b.count : a.index < b.index;
            });
  // The best seeds become groups; further seeds of the same pose add nothing.
  std::size_t found = 0;
  const std::size_t tries = std::min<std::size_t>(seeds, 8 * groups.size());
  for (std::size_t k = 0; k < tries && found < groups.size(); ++k) {
    if (seeds_[k].count < settings.least) break;
    const PosedMatch& seed = matches[seeds_[k].index];
    std::size_t count = 0;
    RigidTransform pose = pose_from_frames(seed);
    // A seed that a known group explains, at about the group's attitude, would only find that group again.
    bool explained = false;
    for (std::size_t g = 0; g < found && settings.use_frames; ++g) {
      const Vector3 gap = groups[g].transform * to_vector(seed.model) - to_vector(seed.scene);
      explained = explained || (squared(gap) < settings.tolerance * settings.tolerance &&
                                cos_angle(groups[g].transform.rotation.transpose() * pose.rotation) > 0.9);
    }
    if (explained) continue;
    if (settings.use_frames) {
      count = gather(matches.size(), pose, seed.model, settings.tolerance, settings.frame_tolerance);
    } else {
      lanes_.consistent_with(seeds_[k].index, tolerance, hits_.first(matches.size()));
      count = collect_hits(matches.size());
    }
    count = drop_inconsistent(matches, count, settings.tolerance);
    if (!rigid_fit(matches, members_.first(count), pose)) continue;
    // The fitted pose gathers anew, now without the seed's own error.
    for (int pass = 0; pass < 3; ++pass) {
      count = gather(matches.size(), pose, seed.model, settings.tolerance, 0);
      if (!rigid_fit(matches, members_.first(count), pose)) break;
    }
    if (count < settings.least) continue;
    bool known = false;
    for (std::size_t g = 0; g < found; ++g) {
      const Vector3 apart = groups[g].transform * to_vector(seed.model) - pose * to_vector(seed.model);
      known = known || (squared(apart) < 0.04 * radius * radius &&
                        cos_angle(groups[g].transform.rotation.transpose() * pose.rotation) > 0.97);
    }
    if (!known) groups[found++] = {pose, static_cast<std::uint32_t>(count)};
  }
  // By falling size; equals keep their order.
  for (std::size_t g = 1; g < found; ++g)
    for (std::size_t k = g; k > 0 && groups[k].members > groups[k - 1].members; --k)
      std::swap(groups[k], groups[k - 1]);
  return found;
}

}  // namespace pliant
