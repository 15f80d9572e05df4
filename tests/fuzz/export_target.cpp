// A log of lcm-logger on its way to `pliant export`: events, messages, frames, the model, places of points.
#include <algorithm>

#include "firmware-app/export/log_exporter.hpp"
#include "tests/fuzz/promises.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace pliant {

namespace {

/// Demands of everything that is handed over what the exporters count on.
class Demanding final : public LogExporter {
 public:
  Outcome pose(std::int64_t /*received_us*/, const PoseMessage& /*pose*/) override { return success(); }
  Outcome frame(std::int64_t /*received_us*/, const ReceivedFrame& frame, const ReceivedModel* model,
                std::span<const Point3f> positions) override {
    ++frames;
    tracked += frame.state == TrackState::tracking ? 1 : 0;
    promise(
        frame.position.size() == frame.deformed.size() && frame.displacement.size() == frame.deformed.size(),
        "every deformed point has a place and a displacement");
    promise(std::is_sorted(frame.deformed.begin(), frame.deformed.end()), "deformed points ascend");
    if (model == nullptr) {
      promise(positions.empty(), "no place without a model");
      return success();
    }
    promise(frame.model_id == model->model_id, "the model is the frame's own");
    promise(positions.size() == model->points.size() && frame.labels.size() == positions.size() &&
                model->normals.size() == positions.size(),
            "every point has a place, a label and a normal");
    return success();
  }
  Outcome status(std::int64_t /*received_us*/, const StatusMessage& status) override {
    promise(*name_of(status.device) != 0 && *name_of(status.stream_fault) != 0, "states have names");
    return success();
  }
  Outcome depth(std::int64_t /*received_us*/, const ReceivedDepth& picture) override {
    promise(intrinsics_fault(picture.camera) == nullptr, "an accepted camera is sound");
    promise(picture.depth.size() == static_cast<std::size_t>(picture.camera.width) *
                                        static_cast<std::size_t>(picture.camera.height),
            "a picture is whole");
    return success();
  }
  Outcome finish() override { return success(); }
  [[nodiscard]] std::string summary() const override { return {}; }

  std::int64_t frames = 0, tracked = 0;
};

}  // namespace

void fuzz_export(Bytes data) {
  const ScratchFile scratch(data);
  const Result<std::vector<ReceivedModel>> models = models_in_log(scratch.path(), "PLIANT");
  if (!models) {
    check_line(models.error().message);
    return;
  }
  Demanding exporter;
  LogExporter* const exporters[] = {&exporter};
  const Result<LogFigures> walked = walk_log(scratch.path(), "PLIANT", *models, exporters);
  if (!walked) {
    promise(walked.error().kind == ErrorKind::bad_input, "a log's error is a bad input");
    check_line(walked.error().message);
    return;
  }
  promise(walked->frames == exporter.frames && walked->tracked == exporter.tracked, "frames are counted");
}

}  // namespace pliant
