// One limb of the warp in another attitude.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/registration/warp_stiffness.hpp"

namespace pliant {

/// Where a limb hangs on what is settled: the mean of the borders between them.
struct LimbJoint {
  std::size_t borders = 0;
  Vector3 model = Vector3::Zero(), scene = Vector3::Zero();  ///< metres
  std::size_t root = 0;                                      ///< settled patch nearest to it
};

[[nodiscard]] LimbJoint joint_of(const WarpRoom& room, const PatchSet& limb) noexcept;

/// What of a limb's samples the scene shows.
struct LimbEvidence {
  double share = 0, samples = 0;
};

/// A limb's patches and samples.
class LimbTrial {
 public:
  static constexpr std::size_t kMostSamples = 150;  ///< of a limb

  LimbTrial(WarpSamples& samples, const WarpStiffness& stiffness, const PatchSet& limb,
            const LimbJoint& joint) noexcept;
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

  /// What the scene shows of it where its patches are.
  [[nodiscard]] LimbEvidence evidence() const noexcept;
  /// How closely targets lie at the limb under one pose, [0, 1]: falls with the square of the distance to
  /// none at `tolerance`, metres.
  [[nodiscard]] double nearness(const RigidTransform& pose, double tolerance) const noexcept;
  /// Rigid steps towards the targets within `gate` (metres). False when too few are there.
  [[nodiscard]] bool align(double gate, RigidTransform& pose) const noexcept;
  /// Gives its patches the pose and lets them bend towards the targets, from within `first` to within `last`
  /// metres; all others stay.
  void bend(const RigidTransform& pose, double first, double last) noexcept;
  /// How far its joint is torn, [0, 1].
  [[nodiscard]] double tear() const noexcept;

 private:
  /// Facing either way: a thin limb's normals may be turned.
  [[nodiscard]] std::uint32_t target_of(const WarpSamples::Placed& sample, double gate, float least_alike,
                                        float& square) const noexcept;
  [[nodiscard]] std::span<const std::uint16_t> few() const noexcept;

  WarpSamples& samples_;
  const WarpStiffness& stiffness_;
  const PatchSet& limb_;
  const LimbJoint& joint_;
  std::array<std::uint16_t, kMostSamples> own_{};
  std::size_t count_ = 0;
};

}  // namespace pliant
