// Which of two motions explains better what is seen of a part of the object.
#pragma once

#include "core/track/patches.hpp"
#include "core/track/sight.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

/// Shares of the inlier limit by which one pose may explain readings worse than two before a region splits,
/// and up to which two regions are one. The limit is 4 σ or more and a reading's mean error after smoothing a
/// third of σ: below a tenth all is noise. The gap between the two keeps a region from coming and going.
inline constexpr double kAsTwo = 0.22, kAsOne = 0.15;

/// The points that are asked: those of region `region`, of `patches` only if given.
struct AskedPoints {
  std::int8_t region = 0;
  const PatchSet* patches = nullptr;
  bool outline = true;  ///< their outline counts, too
  double clear = 1;     ///< what is worse by more than this share of the limit is not asked any further
};

/// By how much pose `other` explains worse than `own` what is seen of the points: the mean distance from the
/// readings along the normal, or from the outline where the surface turns away, no more than the inlier limit
/// for each point, as a share of that limit; surface and outline apart, and the larger of both counts: a part
/// that slides along itself shows it at its outline only. 0 where nothing is seen; negative where `other` is
/// better in both. What neither shows costs nothing.
[[nodiscard]] double worse_by(const ModelTables& model, const PatchTables& patches, const Sighting& sighting,
                              const PointState& points, const AskedPoints& asked, const RigidTransform& own,
                              const RigidTransform& other) noexcept;

}  // namespace pliant
