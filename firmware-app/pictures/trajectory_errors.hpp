// How far a path lies from the truth.
#pragma once

#include <string>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

struct PoseError {
  double seconds = 0;  ///< since the path's first pose
  double shift = 0;    ///< metres
  double angle = 0;    ///< degrees
};

/// Each pose of `path` beside the pose of `truth` of the same time, at most 2 ms away; both files have lines
/// "<seconds> tx ty tz qx qy qz qw". An error where a line is malformed or no pose has a companion.
[[nodiscard]] Result<std::vector<PoseError>> trajectory_errors(const std::string& path,
                                                               const std::string& truth);

class Svg;
inline constexpr double kErrorPlotHeight = 330;
/// Shift and angle over time, from `top` down.
void draw_error_plot(const std::vector<PoseError>& errors, double top, Svg& svg);

}  // namespace pliant
