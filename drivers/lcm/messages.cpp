#include "drivers/lcm/messages.hpp"

#include <algorithm>
#include <cmath>

#include "core/limits.hpp"
#include "drivers/lcm/fingerprint.hpp"
#include "drivers/lcm/status_message.hpp"
#include "drivers/lcm/wire.hpp"

namespace pliant {

namespace {

constexpr std::size_t kRegionBytes = 82;
constexpr std::int16_t kMaxParts = 1024;

bool starts_with(wire::Reader& in, std::uint64_t fingerprint) {
  return in.get<std::uint64_t>() == fingerprint && in.ok();
}

template <typename Number, std::size_t Size>
bool read_finite(wire::Reader& in, std::array<Number, Size>& out) {
  for (Number& value : out) value = in.get<Number>();
  return std::all_of(out.begin(), out.end(), [](Number value) { return std::isfinite(value); });
}

bool read_transform(wire::Reader& in, std::array<double, 3>& trans, std::array<double, 4>& quat) {
  if (!read_finite(in, trans) || !read_finite(in, quat)) return false;
  double squared = 0;
  for (const double q : quat) squared += q * q;
  return std::abs(squared - 1.0) < 1e-6;
}

bool read_points(wire::Reader& in, std::size_t count, std::vector<Point3f>& points) {
  points.resize(count);
  bool finite = true;
  for (Point3f& point : points) {
    std::array<float, 3> xyz{};
    finite = read_finite(in, xyz) && finite;
    point = {xyz[0], xyz[1], xyz[2]};
  }
  return finite;
}

/// Three numbers, or three that are none.
bool read_joint(wire::Reader& in, std::optional<Point3f>& joint) {
  std::array<float, 3> xyz{};
  joint.reset();
  if (read_finite(in, xyz)) {
    joint = Point3f{xyz[0], xyz[1], xyz[2]};
    return true;
  }
  return std::all_of(xyz.begin(), xyz.end(), [](float value) { return std::isnan(value); });
}

/// Finite and no less than 0.
bool is_measure(float value) {
  return value >= 0 && std::isfinite(value);
}

bool read_measures(wire::Reader& in, std::size_t count, std::vector<float>& measures) {
  measures.resize(count);
  for (float& value : measures) value = in.get<float>();
  return std::all_of(measures.begin(), measures.end(), is_measure);
}

bool read_state(wire::Reader& in, TrackState& state) {
  const auto value = in.get<std::int8_t>();
  if (value < 0 || value > static_cast<std::int8_t>(TrackState::lost)) return false;
  state = static_cast<TrackState>(value);
  return true;
}

bool in_unit_range(float value) {
  return value >= 0 && value <= 1;
}

bool read_parts(wire::Reader& in, std::int16_t& part, std::int16_t& parts) {
  part = in.get<std::int16_t>();
  parts = in.get<std::int16_t>();
  return parts >= 1 && parts <= kMaxParts && part >= 0 && part < parts;
}

bool whole(const wire::Reader& in) {
  return in.ok() && in.at_end();
}

}  // namespace

std::string_view channel_suffix(MessageKind kind) noexcept {
  constexpr std::array<std::string_view, kMessageKinds> kSuffixes = {"_POSE",   "_REGIONS", "_DEFORMED",
                                                                     "_STATUS", "_DEPTH",   "_MODEL"};
  return kSuffixes[static_cast<std::size_t>(kind)];
}

bool decode(std::span<const std::uint8_t> body, PoseMessage& message) {
  wire::Reader in(body);
  if (!starts_with(in, wire::kPoseFingerprint)) return false;
  message.utime = in.get<std::int64_t>();
  return read_transform(in, message.trans, message.quat) && whole(in);
}

bool decode(std::span<const std::uint8_t> body, RegionsMessage& message) {
  wire::Reader in(body);
  if (!starts_with(in, wire::kRegionsFingerprint)) return false;
  message.utime = in.get<std::int64_t>();
  message.frame = in.get<std::int64_t>();
  message.model_id = in.get<std::int64_t>();
  if (!read_state(in, message.state)) return false;
  message.confidence = in.get<float>();
  if (!in_unit_range(message.confidence) || !read_parts(in, message.part, message.parts)) return false;

  message.regions.resize(in.get_count(kRegionBytes, limits::kMaxRegions));
  for (RegionMessage& region : message.regions) {
    region.id = in.get<std::int8_t>();
    region.parent = in.get<std::int8_t>();
    region.points = in.get<std::int32_t>();
    region.rms = in.get<float>();
    region.confidence = in.get<float>();
    if (region.id < 0 || region.parent < -1 || region.points < 0 || !is_measure(region.rms) ||
        !in_unit_range(region.confidence) || !read_transform(in, region.trans, region.quat) ||
        !read_joint(in, region.joint)) {
      return false;
    }
  }

  message.model_points = in.get<std::int32_t>();
  message.first_point = in.get<std::int32_t>();
  const std::size_t labels = in.get_count(1, limits::kMaxModelPoints);
  if (message.model_points < 0 || message.model_points > static_cast<std::int32_t>(limits::kMaxModelPoints) ||
      message.first_point < 0 ||
      message.first_point > message.model_points - static_cast<std::int32_t>(labels)) {
    return false;
  }
  const auto bytes = in.get_bytes(labels);
  message.labels.assign(bytes.begin(), bytes.end());
  return whole(in) && std::all_of(message.labels.begin(), message.labels.end(),
                                  [](std::int8_t label) { return label >= kNotObserved; });
}

bool decode(std::span<const std::uint8_t> body, DeformedMessage& message) {
  wire::Reader in(body);
  if (!starts_with(in, wire::kDeformedFingerprint)) return false;
  message.utime = in.get<std::int64_t>();
  message.frame = in.get<std::int64_t>();
  message.model_id = in.get<std::int64_t>();
  if (!read_parts(in, message.part, message.parts)) return false;
  message.num_deformed = in.get<std::int32_t>();
  constexpr std::size_t kPointBytes = sizeof(std::int16_t) + 2 * sizeof(Point3f) + sizeof(float);
  const std::size_t count = in.get_count(kPointBytes, limits::kMaxModelPoints);
  if (!in.ok() || message.num_deformed < static_cast<std::int32_t>(count) ||
      message.num_deformed > static_cast<std::int32_t>(limits::kMaxModelPoints)) {
    return false;
  }
  message.index.resize(count);
  std::int32_t previous = -1;
  for (std::int16_t& index : message.index) {
    index = in.get<std::int16_t>();
    if (index <= previous || index >= static_cast<std::int32_t>(limits::kMaxModelPoints)) return false;
    previous = index;
  }
  return read_points(in, count, message.position) && read_points(in, count, message.displacement) &&
         read_measures(in, count, message.strain) && whole(in);
}

bool decode(std::span<const std::uint8_t> body, StatusMessage& message) {
  wire::Reader in(body);
  if (!starts_with(in, wire::kStatusFingerprint)) return false;
  message.utime = in.get<std::int64_t>();
  message.version = in.get_string();
  message.source = in.get_string();
  message.model_id = in.get<std::int64_t>();
  message.frame = in.get<std::int64_t>();
  if (!read_state(in, message.state)) return false;
  const auto device = in.get<std::int8_t>();
  if (device < 0 || device > static_cast<std::int8_t>(DeviceState::ended)) return false;
  message.device = static_cast<DeviceState>(device);
  const auto fault = in.get<std::int8_t>();
  if (fault < 0 || fault >= kStreamFaults) return false;
  message.stream_fault = static_cast<StreamFault>(fault);
  message.rate = in.get<float>();
  message.strain_energy = in.get<float>();
  if (!is_measure(message.rate) || !is_measure(message.strain_energy)) return false;
  message.latency_median = in.get<std::int32_t>();
  message.latency_p99 = in.get<std::int32_t>();
  message.latency_max = in.get<std::int32_t>();
  // A stage's name takes at least its length and its zero.
  message.stages.resize(in.get_count(sizeof(std::int32_t) + 1, kMaxStatusStages));
  for (StageMessage& stage : message.stages) stage.name = in.get_string();
  for (StageMessage& stage : message.stages) stage.median = in.get<std::int32_t>();
  for (StageMessage& stage : message.stages) stage.p99 = in.get<std::int32_t>();
  for (StageMessage& stage : message.stages) stage.max = in.get<std::int32_t>();
  for (std::int64_t* counter : {&message.tracked,        &message.searching,     &message.lost,
                                &message.dropped,        &message.bad_frames,    &message.zero_frames,
                                &message.stuck_frames,   &message.noise_frames,  &message.wrong_size_frames,
                                &message.delayed_frames, &message.slow_frames,   &message.broken_frames,
                                &message.stalls,         &message.reopenings,    &message.deadline_misses,
                                &message.unsent,         &message.send_failures, &message.workspace_bytes,
                                &message.rss_bytes,      &message.heap_calls,    &message.page_faults}) {
    *counter = in.get<std::int64_t>();
  }
  message.last_error = in.get_string();
  return whole(in);
}

bool decode(std::span<const std::uint8_t> body, DepthMessage& message) {
  wire::Reader in(body);
  if (!starts_with(in, wire::kDepthFingerprint)) return false;
  message.utime = in.get<std::int64_t>();
  message.frame = in.get<std::int64_t>();
  if (!read_parts(in, message.part, message.parts)) return false;
  Intrinsics& camera = message.camera;
  camera.width = in.get<std::int32_t>();
  camera.height = in.get<std::int32_t>();
  for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy, &camera.depth_scale}) {
    *value = in.get<double>();
  }
  message.first_row = in.get<std::int32_t>();
  const auto rows = in.get<std::int32_t>();
  const std::size_t count = in.get_count(1, kMaxDepthMessageBytes);
  if (!in.ok() || intrinsics_fault(camera) != nullptr || message.first_row < 0 || rows < 1 ||
      rows > camera.height - message.first_row ||
      count !=
          sizeof(std::uint16_t) * static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(rows)) {
    return false;
  }
  const auto bytes = in.get_bytes(count);
  message.depth.resize(bytes.size() / 2);
  for (std::size_t i = 0; i < message.depth.size(); ++i) {
    message.depth[i] = static_cast<std::uint16_t>(bytes[2 * i] | (bytes[2 * i + 1] << 8));
  }
  return whole(in);
}

bool decode(std::span<const std::uint8_t> body, ModelMessage& message) {
  wire::Reader in(body);
  if (!starts_with(in, wire::kModelFingerprint)) return false;
  message.model_id = in.get<std::int64_t>();
  if (!read_parts(in, message.part, message.parts)) return false;
  message.model_points = in.get<std::int32_t>();
  message.first_point = in.get<std::int32_t>();
  constexpr std::size_t kPointBytes = 3 * (sizeof(std::int16_t) + sizeof(std::int8_t));
  const std::size_t count = in.get_count(kPointBytes, limits::kMaxModelPoints);
  message.spacing = in.get<float>();
  std::array<float, 3> origin{};
  const bool finite = read_finite(in, origin);
  const auto step = in.get<float>();
  if (!in.ok() || !finite || !(message.spacing >= 0) || !std::isfinite(message.spacing) || !(step > 0) ||
      !std::isfinite(step) || message.model_points < 0 ||
      message.model_points > static_cast<std::int32_t>(limits::kMaxModelPoints) || message.first_point < 0 ||
      message.first_point > message.model_points - static_cast<std::int32_t>(count)) {
    return false;
  }
  message.position.resize(count);
  for (Point3f& point : message.position) {
    std::array<float, 3> xyz{};
    for (std::size_t i = 0; i < 3; ++i)
      xyz[i] = origin[i] + step * static_cast<float>(in.get<std::int16_t>());
    point = {xyz[0], xyz[1], xyz[2]};
  }
  message.normal.resize(count);
  for (Point3f& normal : message.normal) {
    std::array<float, 3> xyz{};
    for (float& value : xyz) value = static_cast<float>(in.get<std::int8_t>()) / 127.0F;
    normal = {xyz[0], xyz[1], xyz[2]};
  }
  return whole(in);
}

}  // namespace pliant
