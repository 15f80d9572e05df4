// The picture of a capture that grows: published over LCM, for `pliant view`.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/capture/object_capture.hpp"
#include "drivers/lcm/publisher.hpp"

namespace pliant {

/// Publishes, as a tracker would, the points captured so far as the model (renewed once a second), where the
/// object is (tracking: the picture was fused), the depth picture five times a second, and a status whose
/// last_error holds what the person is told. Never waits for the network.
class CaptureShow {
 public:
  /// `url` as LcmSettings has it; "none": nothing is published. Null where it cannot be: `warning` says why.
  [[nodiscard]] static std::unique_ptr<CaptureShow> open(const std::string& url, const std::string& source,
                                                         const Intrinsics& camera, double rate,
                                                         std::string& warning);

  void show(const DepthFrame& frame, const ObjectCapture& capture, const CaptureStatus& status,
            const std::string& words);
  /// Sends what is left; what a log could not take.
  [[nodiscard]] Outcome finish();

 private:
  static constexpr std::size_t kMostPoints = 6000;

  CaptureShow(std::unique_ptr<LcmPublisher> publisher, std::string source, const Intrinsics& camera,
              double rate);
  void renew_model(const ObjectCapture& capture);
  void publish_pose(const DepthFrame& frame, const CaptureStatus& status);
  void publish_status(const DepthFrame& frame, const CaptureFigures& figures, const CaptureStatus& status,
                      const std::string& words);

  std::unique_ptr<LcmPublisher> publisher_;
  std::string source_;
  Intrinsics camera_;
  std::int64_t every_, pictures_ = 0;  // pictures a second; so far
  std::uint64_t model_id_ = 0;
  std::vector<Point3f> points_;
  std::vector<Normal16> normals_;
  std::vector<std::int8_t> labels_;
  std::unique_ptr<ModelMessages> model_;
  std::unique_ptr<TrackMessages> track_;
  bool model_is_new_ = false;
};

}  // namespace pliant
