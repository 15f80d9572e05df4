#include "core/registration/warp_starts.hpp"

#include <algorithm>
#include <utility>

#include "core/registration/chain_measures.hpp"

namespace pliant {

namespace {

constexpr double kAround = 0.25;  // of the model's radius: what bears a match out lies so near
constexpr std::size_t kMostAround = 96;
constexpr double kFrameError = 0.25;  // radians that a local frame is off
constexpr std::uint32_t kFewestAgree = 3;
constexpr double kAgreeShare = 0.3;

}  // namespace

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

void find_starts(Warp& w) noexcept {
  RegistrationState& s = w.s;
  const std::size_t count = std::min(s.posed_count, w.room.places.size());
  for (std::size_t k = 0; k < count; ++k) w.room.places[k] = s.posed[k].model;
  const double around = kAround * s.model.radius();
  static_cast<void>(w.room.sample_grid.build(w.room.places.first(count), 0.5 * around));
  for (std::size_t p = 0; p < w.room.patches.count; ++p) w.room.borne[p] = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t p = w.room.patches.patch_of[s.matches[k].model];
    if (w.room.rigid[p]) continue;
    const RigidTransform pose = pose_from_frames(s.posed[k]);
    const Vector3 own = to_vector(s.posed[k].model);
    std::uint32_t near = 0, agree = 0;
    w.room.sample_grid.visit_within(s.posed[k].model, static_cast<float>(around), kMostAround,
                                    [&](std::uint32_t j, const Point3f& m, float /*square*/) {
                                      if (j == k) return;
                                      ++near;
                                      const double limit =
                                          match_tolerance(s) + kFrameError * (to_vector(m) - own).norm();
                                      const Vector3 gap = pose * to_vector(m) - to_vector(s.posed[j].scene);
                                      agree += gap.squaredNorm() < limit * limit ? 1U : 0U;
                                    });
    if (agree < kFewestAgree || static_cast<double>(agree) < kAgreeShare * near) continue;
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
}

}  // namespace pliant
