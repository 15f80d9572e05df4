// What holds two sides of a body together: a spring between the patches on either side of it. The tracker's
// warp and that of clouds lay the same ones.
#pragma once

#include <span>

#include "core/deform/elastic_system.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/track/patches.hpp"

namespace pliant {

/// A patch with less than this share of the readings that it could have, two or three of them, is not seen:
/// what is seen takes it along.
inline constexpr double kFewReadings = 0.1;

/// Weight of a spring that gives way beyond `scale`.
[[nodiscard]] inline double giving_way(double square, double scale) noexcept {
  const double w = scale * scale / (scale * scale + square);
  return w * w;
}

/// Adds a tie as stiff as `stiffness`, in weighted readings, that gives way to a dent beyond `give`, metres.
/// `pose`: of each patch.
inline void add_tie(const PatchTables& patches, const PatchTie& tie, std::span<const RigidTransform> pose,
                    double stiffness, double give, ElasticSystem& system) noexcept {
  PatchMeeting meeting = meeting_of(patches, pose, tie.a, tie.b, tie.middle);
  meeting.link.stretch = stiffness * giving_way(meeting.gap.squaredNorm(), give);
  system.add_link(meeting.link, meeting.gap, Vector3::Zero());
}

}  // namespace pliant
