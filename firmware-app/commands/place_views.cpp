#include "firmware-app/commands/place_views.hpp"

#include <algorithm>

#include "drivers/model_files/captured_mesh.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "firmware-app/commands/one_shot_detector.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant {

namespace {

/// A model of what is known so far, and the search for it.
struct Search {
  BuiltModel built;
  ModelView model;
  std::unique_ptr<OneShotDetector> detector;
};

Result<Search> search_for(const ObjectCapture& capture, const Intrinsics& camera,
                          const SensorDescription& sensor) {
  CapturedMeshSettings cleaning;
  cleaning.table_height = capture.table_height();
  cleaning.least_weight = kSeenWell;
  ModelBuildSettings settings;
  settings.wound_outward = true;
  settings.front_only = true;
  Result<BuiltModel> built = build_model(captured_mesh(capture.volume(), cleaning), settings);
  if (!built)
    return Error{ErrorKind::bad_input, "too little of the object was seen to find it in other views"};
  Search search;
  search.built = std::move(*built);
  if (ModelView::open(search.built.image, search.model) != ModelFault::none)
    return Error{ErrorKind::bad_input, "internal error: the model of the first views is none"};
  Result<std::unique_ptr<OneShotDetector>> detector = OneShotDetector::create(search.model, camera, sensor);
  if (!detector) return detector.error();
  search.detector = std::move(*detector);
  return search;
}

/// The poses that the search looked at closely, the best first: which of them it is, the fit tells.
bool place(const DepthFrame& view, Search& search, ObjectCapture& capture) {
  static_cast<void>(search.detector->look(view));
  std::vector<PoseCandidate> poses(search.detector->candidates().begin(),
                                   search.detector->candidates().end());
  std::stable_sort(poses.begin(), poses.end(),
                   [](const PoseCandidate& a, const PoseCandidate& b) { return a.score > b.score; });
  return std::any_of(poses.begin(), poses.end(), [&](const PoseCandidate& pose) {
    return capture.process_near(view, pose.pose).state == CaptureState::capturing;
  });
}

}  // namespace

Result<std::vector<std::size_t>> place_views(const std::vector<DepthFrame>& views, const Intrinsics& camera,
                                             const SensorDescription& sensor, ObjectCapture& capture,
                                             const std::function<void(std::size_t)>& tell) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const bool done = capture.figures().fused > 0 || StopSignal::requested();
    if (done || capture.process(views[i]).state != CaptureState::capturing) left.push_back(i);
  }
  while (!left.empty() && capture.figures().fused > 0 && !StopSignal::requested()) {
    tell(views.size() - left.size());
    Result<Search> search = search_for(capture, camera, sensor);
    if (!search) return search.error();
    bool placed = false;
    const auto next = std::find_if(left.begin(), left.end(), [&](std::size_t i) {
      placed = !StopSignal::requested() && place(views[i], *search, capture);
      return placed || StopSignal::requested();
    });
    if (!placed) break;
    left.erase(next);
  }
  return left;
}

}  // namespace pliant
