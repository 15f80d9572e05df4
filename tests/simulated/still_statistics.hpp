// What the frames of a still scene tell about the sensor that took them.
#pragma once

#include <cstdint>
#include <vector>

namespace pliant {

/// Frames of one still scene, all of the same size.
struct StillScene {
  int width = 0;
  int height = 0;
  std::vector<std::vector<std::uint16_t>> frames;  ///< millimetres
};

/// Disparity in eighths of a pixel at 570 pixels · 75 mm.
struct StillStatistics {
  double step = 0;           ///< mean distance of neighbouring values between 0.7 and 0.76 m, millimetres
  double flicker = 0;        ///< median over pixels of the spread over time, eighths; smooth, 0.45 to 0.75 m
  double correlation = 0;    ///< of the flicker of horizontal neighbours, same pixels
  double lost_inside = 0;    ///< share of readings lost far from edges, nearer than 0.8 m
  double lost_at_edges = 0;  ///< the same within a pixel of an edge
  double flying_at_edges = 0;  ///< share of readings at edges more than 10 mm off the pixel's mean
};

[[nodiscard]] StillStatistics statistics_of(const StillScene& scene);

}  // namespace pliant
