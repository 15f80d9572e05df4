// What the warp of a cloud compares: samples of the model where their patches put them, and targets, the
// scene's points with their normals, each owned by the settled patch that lies on it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/registration/warp_starts.hpp"

namespace pliant {

class WarpSamples {
 public:
  static constexpr std::uint8_t kNoOwner = 255;
  /// Cosine between normals of what may belong together, and of what surely does.
  static constexpr float kAlike = 0.5F, kMuchAlike = 0.7F;

  /// Takes the targets, what no other instance holds. The samples are the first points of the model, which
  /// are spread evenly. Without targets there is nothing to do.
  explicit WarpSamples(Warp& warp) noexcept;

  [[nodiscard]] Warp& warp() const noexcept { return w_; }
  [[nodiscard]] WarpRoom& room() const noexcept { return w_.room; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t target_count() const noexcept { return targets_; }
  [[nodiscard]] std::size_t patch_of(std::size_t sample) const noexcept {
    return w_.room.patches.patch_of[sample];
  }
  /// Distance between neighbouring samples, or targets, whichever are farther apart, metres.
  [[nodiscard]] double reach() const noexcept { return reach_; }

  /// Where a pose of its patch puts a sample.
  struct Placed {
    Point3f at, normal;
  };
  [[nodiscard]] Placed placed(std::size_t sample, const FastTransform& pose) const noexcept {
    return {pose.point(w_.s.model.positions()[sample]), pose.direction(w_.s.model.normals()[sample])};
  }
  /// Places all samples by their patches' poses: room.places and room.normals.
  void place() noexcept;
  /// Gives the targets to the settled patches that lie on them.
  void find_owners() noexcept;
  /// Takes the targets of these patches away from them.
  void free_targets(const PatchSet& patches) noexcept;

  /// The nearest target within `gate` (metres) that faces `facing` times the way of the sample (0: either
  /// way) and whose owner, if it has one, `may`(owner) share it; PointGrid::kNone for none.
  template <typename May>
  [[nodiscard]] std::uint32_t target_of(const Placed& sample, double gate, float least_alike, float facing,
                                        float& square, May&& may) const noexcept {
    const WarpRoom& room = w_.room;
    return room.target_grid.nearest_if(
        sample.at, static_cast<float>(gate), square, [&](std::uint32_t t) noexcept {
          const Normal16& m = room.target_normals[t];
          const float cosine =
              (sample.normal.x * static_cast<float>(m.x) + sample.normal.y * static_cast<float>(m.y) +
               sample.normal.z * static_cast<float>(m.z)) *
              (1.0F / 16384);
          if ((facing == 0 ? std::fabs(cosine) : facing * cosine) <= least_alike) return false;
          return room.owner[t] == kNoOwner || may(room.owner[t]);
        });
  }
  /// Whether `target` shows the surface at the sample: as near to its plane as noise and sampling leave it.
  [[nodiscard]] bool shows(const Placed& sample, std::uint32_t target) const noexcept;

  /// Counts of each patch, where the samples are placed: room.asked and room.close.
  void count_close() noexcept;
  /// Which way the scene's normals about these patches point: a thin part's are turned as a whole. Counts
  /// anew.
  void find_facing(const PatchSet& patches) noexcept;

 private:
  void take_targets() noexcept;
  /// A cloud taken from one place shows only what faces it.
  [[nodiscard]] bool may_be_seen(const Placed& sample) const noexcept;

  Warp& w_;
  std::size_t count_ = 0, targets_ = 0;
  double reach_ = 0;
};

/// The reading of a sample at `place` by a target at a squared distance: it should come there along the
/// target's normal and a little across. Its weight (Tukey's) falls to none at `gate`, metres. `centre`: about
/// which the patch turns.
void add_reading(const WarpSamples& samples, const Point3f& place, std::uint32_t target, float square,
                 double gate, const Vector3& centre, Symmetric6& a, Vector6& b) noexcept;

}  // namespace pliant
