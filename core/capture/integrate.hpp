// Fuses a view into the volume.
#pragma once

#include "core/capture/distance_volume.hpp"
#include "core/capture/view_picture.hpp"
#include "core/track/model_tables.hpp"

namespace pliant {

/// Each node of the active blocks takes the distance of the reading on its line of sight, measured along that
/// reading's normal, into its running mean; readings seen straight on weigh up to sixteen times one seen
/// flat. Nodes and whole blocks that the camera sees through are noted as free, with the least weight.
/// `pose`: camera <- model, within 2 m. Integers only; the order of views matters only by rounding of 1/256
/// mm.
void integrate(const ViewPicture& picture, const Projector& projector, const FixedPose& pose,
               const FixedPose& model_from_camera, const Surface& rays, DistanceVolume& volume) noexcept;

/// A node's weight ends here: some hundred straight views. Later ones then count as a moving mean.
inline constexpr std::int32_t kMostWeight = 2000;

}  // namespace pliant
