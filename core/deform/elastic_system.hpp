// The linear system of one step of the warp: how far every patch turns and moves, so that readings, springs
// and the regions that the patches hang on are in balance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/deform/symmetric6.hpp"
#include "core/track/patches.hpp"

namespace pliant {

/// A border between two patches, or what ties them across the body. Stretching it is stiff, bending it is
/// soft.
struct ElasticLink {
  std::uint8_t a = 0, b = 0;
  double stretch = 0;    ///< stiffness of the point where they meet, in weighted readings
  double bend = 0;       ///< of the angle between them, in weighted readings times metres squared
  Vector3 arm_a, arm_b;  ///< from the patches' centres to where each puts the point, camera frame, metres
};

/// Where two patches meet, or are tied together: a link without stiffness yet, and the gap that it closes.
struct PatchMeeting {
  ElasticLink link;
  Vector3 gap;  ///< from where b puts the shared point to where a does
};

/// `pose`: of each patch; `point`: what a and b share, model frame, metres.
[[nodiscard]] inline PatchMeeting meeting_of(const PatchTables& patches, std::span<const RigidTransform> pose,
                                             std::uint8_t a, std::uint8_t b, const Vector3& point) noexcept {
  const Vector3 at_a = pose[a] * point, at_b = pose[b] * point;
  PatchMeeting meeting;
  meeting.link.a = a;
  meeting.link.b = b;
  meeting.link.arm_a = at_a - pose[a] * patches.centres[a];
  meeting.link.arm_b = at_b - pose[b] * patches.centres[b];
  meeting.gap = at_a - at_b;
  return meeting;
}

/// Solved by conjugate gradients with a bounded number of iterations, preconditioned by the 6×6 blocks of the
/// diagonal: a bounded number of operations in a fixed order.
class ElasticSystem {
 public:
  void clear(std::size_t patches) noexcept;
  /// Patch p stays where it is: what its links pull at is the rest. After clear(), before the links.
  void hold(std::size_t p) noexcept { held_[p] = true; }
  [[nodiscard]] bool holds(std::size_t p) const noexcept { return held_[p]; }

  /// Own forces of patch p: readings and what anchors it.
  [[nodiscard]] Symmetric6& own(std::size_t p) noexcept { return own_[p]; }
  [[nodiscard]] Vector6& force(std::size_t p) noexcept { return force_[p]; }
  /// Nothing between two patches that are held. `gap`: from where b puts the shared point to where a does;
  /// `turn`: rotation vector from b to a.
  void add_link(const ElasticLink& link, const Vector3& gap, const Vector3& turn) noexcept;

  /// The motions of all patches about their centres. Ends after `iterations`, or when what is left unbalanced
  /// is worth no more than `enough`, in weighted readings times metres squared. False when the system is
  /// singular.
  [[nodiscard]] bool solve(int iterations, double enough = 1e-30) noexcept;
  [[nodiscard]] const Vector6& motion(std::size_t p) const noexcept { return x_[p]; }

 private:
  using Vectors = std::array<Vector6, kMaxPatches>;
  void multiply(const Vectors& x, Vectors& y) const noexcept;
  [[nodiscard]] double dot(const Vectors& x, const Vectors& y) const noexcept;

  std::size_t count_ = 0, links_count_ = 0, moving_count_ = 0;
  std::array<bool, kMaxPatches> held_{};
  std::array<std::uint8_t, kMaxPatches> moving_{};  // those that are not held, ascending
  std::array<ElasticLink, kMaxBorders + kMaxBodyLinks> links_;
  std::array<Symmetric6, kMaxPatches> own_, block_;
  std::array<Factor6, kMaxPatches> factor_;
  Vectors force_, x_, residual_, direction_, scratch_;
};

}  // namespace pliant
