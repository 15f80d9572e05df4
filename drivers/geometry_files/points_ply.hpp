// The points file: where every model point is in one frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/rigid_transform.hpp"
#include "core/track_result.hpp"
#include "drivers/common/result.hpp"

namespace pliant {

/// Writes points files of one model: binary little-endian PLY, one vertex a model point in the model's order,
///   float x y z               where it is now, camera or scene frame, metres
///   float rest_x rest_y rest_z  model frame, metres
///   int region                region id, -1 deformed, -2 not observed
///   int match                 pixel v * width + u or scene point, -1 none
///   float residual            metres
///   uchar red green blue      region_colour(region)
/// All memory is taken by the constructor; a write makes no heap call unless it fails.
class PointsPlyWriter {
 public:
  static constexpr std::size_t kBytesPerPoint = 39;

  /// `rest`: the model's points, in its order.
  explicit PointsPlyWriter(std::span<const Point3f> rest);

  /// Each span holds one entry a model point. The file appears under `path` only once it is whole.
  [[nodiscard]] Outcome write(const char* path, std::span<const Point3f> positions,
                              std::span<const std::int8_t> labels, std::span<const std::int32_t> matches,
                              std::span<const float> residuals);
  /// A frame's result, whose state must be tracking.
  [[nodiscard]] Outcome write(const char* path, const TrackResult& result) {
    return write(path, result.positions, result.labels, result.matches, result.residuals);
  }

  [[nodiscard]] std::size_t file_bytes() const { return bytes_.size(); }

 private:
  std::size_t points_;
  std::size_t header_bytes_;
  std::vector<std::byte> bytes_;  // the whole file; header and rest positions are put in once
};

}  // namespace pliant
