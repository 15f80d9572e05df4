// Made-up tracking results with every field of the messages filled with something that differs.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/track_result.hpp"

namespace pliant {

/// Owns what a TrackResult points to.
struct SampleResult {
  std::vector<Point3f> rest, positions;
  std::vector<std::int8_t> labels;
  std::vector<float> strains;
  std::vector<Region> regions;
  TrackResult result;

  /// A tracked frame of `points` points in which every `deformed_every`-th one is deformed (0: none).
  explicit SampleResult(std::size_t points, std::size_t deformed_every = 10, std::size_t region_count = 3) {
    result.utime = 1'700'000'000'123'456;
    result.frame = 4711;
    result.state = TrackState::tracking;
    result.confidence = 0.75F;
    result.pose.rotation = rotation_from_small_vector({0.3, -0.2, 0.1});
    result.pose.translation = {0.05, -0.04, 0.63};
    for (std::size_t i = 0; i < points; ++i) {
      const auto f = static_cast<float>(i);
      rest.push_back({0.00001F * f, 0.05F - 0.00002F * f, 0.003F * static_cast<float>(i % 7)});
      positions.push_back({0.1F + 0.00003F * f, -0.2F, 0.6F + 0.001F * static_cast<float>(i % 11)});
      const bool deformed = deformed_every > 0 && i % deformed_every == 0;
      labels.push_back(deformed     ? kDeformed
                       : i % 4 == 3 ? kNotObserved
                                    : static_cast<std::int8_t>(i % region_count));
      strains.push_back(deformed ? 0.01F * static_cast<float>(i % 13) : 0.0F);
    }
    for (std::size_t k = 0; k < region_count; ++k) {
      Region region;
      region.id = static_cast<std::int8_t>(k);
      region.parent = static_cast<std::int8_t>(k == 0 ? -1 : 0);
      region.points = static_cast<std::uint32_t>(1000 + k);
      region.rms = 0.001F * static_cast<float>(k + 1);
      region.confidence = 1.0F / static_cast<float>(k + 1);
      region.pose.rotation = rotation_from_small_vector({0.1 * static_cast<double>(k), 0.2, -0.4});
      region.pose.translation = {0.01 * static_cast<double>(k), 0.02, 0.7};
      // The base hangs on nothing, and the last region does not touch its parent.
      constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
      const auto place = static_cast<float>(k);
      const bool hangs = k > 0 && k + 1 < region_count;
      region.joint = hangs ? Point3f{0.1F * place, -0.05F, 0.65F} : Point3f{kNone, kNone, kNone};
      regions.push_back(region);
    }
    attach();
  }
  SampleResult(const SampleResult&) = delete;
  SampleResult& operator=(const SampleResult&) = delete;

  void attach() {
    result.regions = regions;
    result.positions = positions;
    result.labels = labels;
    result.strains = strains;
  }
  /// Not tracked: as the tracker gives it, without spans.
  void lose(TrackState state) {
    result.state = state;
    result.regions = {};
    result.positions = {};
    result.labels = {};
    result.strains = {};
  }
};

inline constexpr std::uint64_t kSampleModelId = 0xFEDCBA9876543210;

}  // namespace pliant
