// Walks through a log of lcm-logger and hands what a tracker published in it to exporters.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"
#include "drivers/lcm/frame_assembler.hpp"

namespace pliant {

/// One way to write a log. Each call may fail with an ErrorKind::write, which ends the walk. `received_us`:
/// when the logger took the message, microseconds since the epoch.
class LogExporter {
 public:
  LogExporter() = default;
  LogExporter(const LogExporter&) = delete;
  LogExporter& operator=(const LogExporter&) = delete;
  virtual ~LogExporter() = default;

  [[nodiscard]] virtual Outcome pose(std::int64_t /*received_us*/, const PoseMessage& /*pose*/) {
    return success();
  }
  /// A whole frame. `model` is null and `positions` empty where the frame's model is not known or the object
  /// is not tracked.
  [[nodiscard]] virtual Outcome frame(std::int64_t /*received_us*/, const ReceivedFrame& /*frame*/,
                                      const ReceivedModel* /*model*/,
                                      std::span<const Point3f> /*positions*/) {
    return success();
  }
  [[nodiscard]] virtual Outcome status(std::int64_t /*received_us*/, const StatusMessage& /*status*/) {
    return success();
  }
  [[nodiscard]] virtual Outcome depth(std::int64_t /*received_us*/, const ReceivedDepth& /*depth*/) {
    return success();
  }
  /// After the last event: what is written is whole.
  [[nodiscard]] virtual Outcome finish() = 0;
  /// What was written, for people: "300 files in DIR".
  [[nodiscard]] virtual std::string summary() const = 0;
};

struct LogFigures {
  std::int64_t frames = 0;      ///< whole
  std::int64_t tracked = 0;     ///< of them
  std::int64_t incomplete = 0;  ///< frames of which a message is missing
  std::int64_t garbage = 0;     ///< bodies on the tracker's channels that are not sound
  std::int64_t damages = 0;     ///< stretches of the file that are no event: cut off, or overwritten
};

/// The models announced in a log, each once; more than 16 are left out.
[[nodiscard]] Result<std::vector<ReceivedModel>> models_in_log(const std::string& path,
                                                               std::string_view prefix);

/// Every message of the channels `prefix`_… in the file's order. An error where there is none, with the
/// prefixes that there are.
[[nodiscard]] Result<LogFigures> walk_log(const std::string& path, std::string_view prefix,
                                          std::span<const ReceivedModel> models,
                                          std::span<LogExporter* const> exporters);

}  // namespace pliant
