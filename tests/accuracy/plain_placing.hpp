// Where a tracked frame puts the model's points without the warp: what it is compared with.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/model/model_view.hpp"
#include "core/track_result.hpp"

namespace pliant {

class PlainPlacing {
 public:
  /// Keeps a view of the model, which must outlive it.
  explicit PlainPlacing(const ModelView& model);

  /// Every point where the transform of its region puts it; a deformed or hidden point where that of the
  /// nearest rigid point, in the model, does.
  void rigid(const TrackResult& result, std::vector<Point3f>& places);

  /// The paper's radius search (section 3.2): the same, but each deformed point on the nearest reading within
  /// `radius` (metres) that no rigid point and no other deformed point has taken.
  void radius_search(const TrackResult& result, const DepthFrame& frame, const Intrinsics& camera,
                     double radius, std::vector<Point3f>& places);

 private:
  std::span<const Point3f> rest_;
  std::vector<std::size_t> rigid_points_;
  std::vector<bool> taken_;  // pixels
};

}  // namespace pliant
