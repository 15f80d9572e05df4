// Copies of some frames and their results, and the pictures made of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/model/model_view.hpp"
#include "core/track_result.hpp"
#include "drivers/common/result.hpp"

namespace pliant::demo {

/// Takes the frames asked for, or the first ones after them where those were dropped. All memory is taken at
/// the start; look() makes no heap call.
class Snapshots {
 public:
  /// `model`'s memory must outlive this.
  Snapshots(const Intrinsics& camera, const ModelView& model, std::span<const std::int64_t> frames);
  void look(const DepthFrame& frame, const TrackResult& result);

  /// Depth in grey, the observed points in their regions' colours, a key: NNNNNN.png for each frame taken.
  /// The folder is made if need be. Number of pictures.
  [[nodiscard]] Result<int> write(const std::string& folder) const;

 private:
  struct Shot {
    std::int64_t wanted = 0, frame = -1;
    TrackState state = TrackState::searching;
    RigidTransform pose;
    std::vector<std::uint16_t> depth;
    std::vector<Point3f> positions;
    std::vector<std::int8_t> labels;
  };
  [[nodiscard]] Outcome draw(const Shot& shot, const std::string& path) const;

  Intrinsics camera_;
  ModelView model_;
  std::vector<Shot> shots_;
  std::size_t next_ = 0;
};

}  // namespace pliant::demo
