#include "firmware-app/commands/capture_show.hpp"

#include <algorithm>
#include <utility>

#include "core/capture/surface_points.hpp"
#include "drivers/model_files/captured_mesh.hpp"

namespace pliant {

namespace {

TrackState state_of(CaptureState state) {
  switch (state) {
    case CaptureState::capturing:
      return TrackState::tracking;
    case CaptureState::lost:
      return TrackState::lost;
    case CaptureState::waiting:
      break;
  }
  return TrackState::searching;
}

}  // namespace

std::unique_ptr<CaptureShow> CaptureShow::open(const std::string& url, const std::string& source,
                                               const Intrinsics& camera, double rate, std::string& warning) {
  if (url == "none") return nullptr;
  LcmSettings settings;
  settings.url = url;
  settings.prefix += kCaptureWord;
  settings.depth_width = camera.width;
  settings.depth_height = camera.height;
  Result<std::unique_ptr<LcmPublisher>> publisher = LcmPublisher::create(settings, kMostPoints);
  if (!publisher) {
    warning = publisher.error().message;
    return nullptr;
  }
  warning = (*publisher)->warning();
  return std::unique_ptr<CaptureShow>(new CaptureShow(std::move(*publisher), source, camera, rate));
}

CaptureShow::CaptureShow(std::unique_ptr<LcmPublisher> publisher, std::string source,
                         const Intrinsics& camera, double rate)
    : publisher_(std::move(publisher)),
      source_("capture of " + std::move(source)),
      camera_(camera),
      every_(std::max<std::int64_t>(1, static_cast<std::int64_t>(rate))),
      track_(std::make_unique<TrackMessages>(std::span<const Point3f>(), model_id_)) {}

void CaptureShow::show(const DepthFrame& frame, const ObjectCapture& capture, const CaptureStatus& status,
                       const std::string& words) {
  if (pictures_ % every_ == 0) renew_model(capture);
  publish_pose(frame, status);
  if (pictures_ % std::max<std::int64_t>(1, every_ / 5) == 0) publisher_->publish_depth(frame, camera_);
  if (pictures_ % std::max<std::int64_t>(1, every_ / 2) == 0)
    publish_status(frame, capture.figures(), status, words);
  ++pictures_;
}

Outcome CaptureShow::finish() {
  publisher_->finish();
  return publisher_->log_failure();
}

void CaptureShow::renew_model(const ObjectCapture& capture) {
  points_.resize(kMostPoints);
  normals_.resize(kMostPoints);
  const std::size_t count = surface_points(capture.volume(), kSeenWell, points_, normals_);
  points_.resize(count);
  normals_.resize(count);
  if (count == 0) return;
  labels_.assign(count, 0);
  ++model_id_;
  const double voxel = capture.volume().plan().voxel / kUnitsPerMetre;
  model_ = std::make_unique<ModelMessages>(AnnouncedModel{model_id_, 2 * voxel, points_, normals_});
  track_ = std::make_unique<TrackMessages>(points_, model_id_);
  model_is_new_ = true;
}

void CaptureShow::publish_pose(const DepthFrame& frame, const CaptureStatus& status) {
  TrackResult result;
  result.utime = frame.utime;
  result.frame = frame.number;
  result.state = state_of(status.state);
  Region base;
  if (result.state == TrackState::tracking && !points_.empty()) {
    result.confidence = static_cast<float>(status.agreement);
    result.pose = status.pose;
    base.points = static_cast<std::uint32_t>(points_.size());
    base.rms = static_cast<float>(status.rms);
    base.confidence = result.confidence;
    base.pose = status.pose;
    result.regions = {&base, 1};
    result.positions = points_;
    result.labels = labels_;
  }
  // A new model goes out whole with the first frame of it, so that the picture does not flicker.
  std::vector<MessageBody> bodies;
  if (model_is_new_) bodies.assign(model_->bodies().begin(), model_->bodies().end());
  model_is_new_ = false;
  const std::span<const MessageBody> track = track_->encode(result);
  bodies.insert(bodies.end(), track.begin(), track.end());
  publisher_->publish(bodies, frame.utime);
}

void CaptureShow::publish_status(const DepthFrame& frame, const CaptureFigures& figures,
                                 const CaptureStatus& status, const std::string& words) {
  StatusContent content;
  content.utime = frame.utime;
  content.version = PLIANT_VERSION;
  content.source = source_;
  content.model_id = model_id_;
  content.frame = frame.number;
  content.state = state_of(status.state);
  content.device = DeviceState::streaming;
  content.rate = static_cast<float>(every_);
  content.tracked = figures.fused;
  content.lost = figures.lost;
  content.searching = figures.frames - figures.fused - figures.lost;
  content.last_error = words;
  publisher_->publish_status(content);
}

}  // namespace pliant
