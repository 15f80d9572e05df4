// The pictures of a capture: taken from a source as they come, or views of unknown poses that are placed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/capture/object_capture.hpp"
#include "drivers/common/result.hpp"
#include "drivers/depth_source/depth_source.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/recording/pose_list.hpp"

namespace pliant {

/// What `pliant model capture` was told.
struct CaptureOptions {
  std::string source, output, ply, sensor, poses, camera, units = "m", lcm_url;
  std::vector<std::string> views;
  std::vector<int> at;
  std::int64_t frames = -1;
  CaptureSettings capture;
  double material = ModelBuildSettings().material;
  std::vector<StampedPose> known;  ///< what --poses names
};

/// How the pictures ended.
struct Taken {
  SourceEvent last = SourceEvent::end;
  std::string fault;
  bool log_failed = false;
  std::int64_t bad_frames = 0;  ///< and those without a known pose, where poses were given
};

/// Until the source ends, enough frames came, or a signal asks for the end; guides the person meanwhile.
[[nodiscard]] Taken take_pictures(DepthSource& source, const CaptureOptions& options, ObjectCapture& capture);

/// Views of unknown poses, from any source that can be read to its end.
[[nodiscard]] Result<Taken> take_views(DepthSource& source, const CaptureOptions& options,
                                       const SensorDescription& sensor, ObjectCapture& capture);

}  // namespace pliant
