// What the messages hold, on the receiving side, and how they are decoded. See types/*.lcm for the
// meaning, units and frames of every field.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera/intrinsics.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/track_result.hpp"
#include "drivers/depth_source/device_state.hpp"

namespace pliant {

/// The channels; a frame's messages are sent in this order.
enum class MessageKind : std::uint8_t { pose, regions, deformed, status, depth, model };
inline constexpr int kMessageKinds = 6;

/// "_POSE", "_REGIONS", "_DEFORMED", "_STATUS", "_DEPTH", "_MODEL".
[[nodiscard]] std::string_view channel_suffix(MessageKind kind) noexcept;

/// Behind the prefix of what the capture of a model publishes: it is no tracked object, so it keeps off the
/// tracker's channels. The viewer listens to both.
inline constexpr const char* kCaptureWord = "_CAPTURE";

/// No message body is longer, but for depth.
inline constexpr std::size_t kMaxMessageBytes = 16000;
/// Fits one datagram with the channel's name.
inline constexpr std::size_t kMaxDepthMessageBytes = 60000;

struct PoseMessage {
  std::int64_t utime = 0;
  std::array<double, 3> trans{};
  std::array<double, 4> quat{1, 0, 0, 0};  ///< w, x, y, z
};

struct RegionMessage {
  std::int8_t id = 0, parent = -1;
  std::int32_t points = 0;
  float rms = 0, confidence = 0;
  std::array<double, 3> trans{};
  std::array<double, 4> quat{1, 0, 0, 0};  ///< w, x, y, z
  /// Camera frame, metres; empty for the base and where the region does not touch its parent.
  std::optional<Point3f> joint;
};

struct RegionsMessage {
  std::int64_t utime = 0, frame = 0, model_id = 0;
  TrackState state = TrackState::searching;
  float confidence = 0;
  std::int16_t part = 0, parts = 1;
  std::vector<RegionMessage> regions;
  std::int32_t model_points = 0, first_point = 0;
  std::vector<std::int8_t> labels;
};

struct DeformedMessage {
  std::int64_t utime = 0, frame = 0, model_id = 0;
  std::int16_t part = 0, parts = 1;
  std::int32_t num_deformed = 0;
  std::vector<std::int16_t> index;
  std::vector<Point3f> position, displacement;
  std::vector<float> strain;  ///< shares, no less than 0
};

struct StageMessage {
  std::string name;
  std::int32_t median = 0, p99 = 0, max = 0;  ///< µs
};

struct StatusMessage {
  std::int64_t utime = 0;
  std::string version, source;
  std::int64_t model_id = 0, frame = -1;
  TrackState state = TrackState::searching;
  DeviceState device = DeviceState::absent;
  StreamFault stream_fault = StreamFault::none;
  float rate = 0, strain_energy = 0;
  std::int32_t latency_median = 0, latency_p99 = 0, latency_max = 0;
  std::vector<StageMessage> stages;
  std::int64_t tracked = 0, searching = 0, lost = 0, dropped = 0, bad_frames = 0, deadline_misses = 0;
  std::int64_t zero_frames = 0, stuck_frames = 0, noise_frames = 0, wrong_size_frames = 0, delayed_frames = 0,
               slow_frames = 0, broken_frames = 0, stalls = 0, reopenings = 0;
  std::int64_t unsent = 0, send_failures = 0;
  std::int64_t workspace_bytes = 0, rss_bytes = 0, heap_calls = 0, page_faults = 0;
  std::string last_error;
};

struct DepthMessage {
  std::int64_t utime = 0, frame = 0;
  std::int16_t part = 0, parts = 1;
  Intrinsics camera;  ///< of the whole picture
  std::int32_t first_row = 0;
  std::vector<std::uint16_t> depth;  ///< whole rows, from `first_row` on; raw units, 0 = no reading
};

struct ModelMessage {
  std::int64_t model_id = 0;
  std::int16_t part = 0, parts = 1;
  std::int32_t model_points = 0, first_point = 0;
  float spacing = 0;              ///< metres
  std::vector<Point3f> position;  ///< model frame, metres
  std::vector<Point3f> normal;    ///< of unit length to within 2 %
};

/// Decode a message body of any origin. False, and `message` of no use, where the body is not a whole, sound
/// message of its type: wrong fingerprint, cut short, bytes left over, counts or indices out of range,
/// numbers that are not finite (but for a joint that is none), quaternions that are not unit. Storage in
/// `message` is reused.
[[nodiscard]] bool decode(std::span<const std::uint8_t> body, PoseMessage& message);
[[nodiscard]] bool decode(std::span<const std::uint8_t> body, RegionsMessage& message);
[[nodiscard]] bool decode(std::span<const std::uint8_t> body, DeformedMessage& message);
[[nodiscard]] bool decode(std::span<const std::uint8_t> body, StatusMessage& message);
[[nodiscard]] bool decode(std::span<const std::uint8_t> body, DepthMessage& message);
[[nodiscard]] bool decode(std::span<const std::uint8_t> body, ModelMessage& message);

}  // namespace pliant
