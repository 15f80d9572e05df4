// The model's frame, as the first view of the object gives it.
#pragma once

#include <cstdint>
#include <span>

#include "core/capture/background.hpp"
#include "core/capture/object_cells.hpp"
#include "core/capture/view_picture.hpp"

namespace pliant {

struct FirstView {
  RigidTransform pose;      ///< camera <- model
  double table_height = 0;  ///< in the model's frame, metres; lower than the cube without a table
  bool too_large = false;   ///< the object reaches out of the cube
};

/// Puts the cube of edge 2 · `half` (1/16 mm) around the target: z along the normal of the table that it
/// stands on (without one: against the picture's v), y away from the camera; the table inside by a little,
/// the object in the middle. `points`: readings of the target.
[[nodiscard]] FirstView place_first_view(std::span<const ViewPoint> points, const Target& target,
                                         std::span<const BackgroundPlane> planes, std::int32_t half) noexcept;

}  // namespace pliant
