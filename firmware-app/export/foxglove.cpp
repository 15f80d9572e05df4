// A log as Foxglove's own message types, in JSON.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "drivers/geometry_files/region_colours.hpp"
#include "firmware-app/export/exporters.hpp"
#include "firmware-app/export/foxglove_schemas.hpp"
#include "firmware-app/export/mcap_writer.hpp"
#include "firmware-app/outputs/status_counts.hpp"
#include "firmware-app/outputs/words.hpp"

namespace pliant {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCamera = "camera";

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < have ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= have ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

Json time_of(std::int64_t utime) {
  const std::int64_t seconds = utime >= 0 ? utime / 1'000'000 : -((999'999 - utime) / 1'000'000);
  return {{"sec", seconds}, {"nsec", (utime - seconds * 1'000'000) * 1000}};
}

Json joint_of(const RegionMessage& region) {
  if (!region.joint) return nullptr;
  return {{"x", region.joint->x}, {"y", region.joint->y}, {"z", region.joint->z}};
}

void put_float(std::string& out, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (unsigned i = 0; i < 4; ++i) out += static_cast<char>(bits >> (8 * i) & 0xFFU);
}

std::uint64_t nanoseconds(std::int64_t microseconds) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(microseconds, 0)) * 1000;
}

class FoxgloveExporter final : public LogExporter {
 public:
  FoxgloveExporter(McapWriter writer, std::string path) : writer_(std::move(writer)), path_(std::move(path)) {
    transforms_ = channel("/tf", "foxglove.FrameTransform");
    points_ = channel("/pliant/points", "foxglove.PointCloud");
    depth_ = channel("/pliant/depth", "foxglove.RawImage");
    camera_ = channel("/pliant/camera", "foxglove.CameraCalibration");
    frames_ = channel("/pliant/frame", "pliant.Frame");
    status_ = channel("/pliant/status", "pliant.Status");
  }

  Outcome frame(std::int64_t received_us, const ReceivedFrame& frame, const ReceivedModel* model,
                std::span<const Point3f> positions) override {
    Json regions = Json::array();
    for (const RegionMessage& r : frame.regions) {
      regions.push_back({{"id", r.id},
                         {"parent", r.parent},
                         {"points", r.points},
                         {"rms", r.rms},
                         {"confidence", r.confidence},
                         {"joint", joint_of(r)}});
      const Json transform = {
          {"timestamp", time_of(frame.utime)},
          {"parent_frame_id", kCamera},
          {"child_frame_id", fmt::format("region_{}", r.id)},
          {"translation", {{"x", r.trans[0]}, {"y", r.trans[1]}, {"z", r.trans[2]}}},
          {"rotation", {{"x", r.quat[1]}, {"y", r.quat[2]}, {"z", r.quat[3]}, {"w", r.quat[0]}}}};
      if (Outcome done = put(transforms_, received_us, frame.utime, transform); !done) return done;
    }
    const Json state = {{"utime", frame.utime},
                        {"frame", frame.frame},
                        {"state", state_word(frame.state)},
                        {"confidence", frame.confidence},
                        {"deformed", frame.deformed.size()},
                        {"not_observed", std::count(frame.labels.begin(), frame.labels.end(), kNotObserved)},
                        {"regions", regions}};
    if (Outcome done = put(frames_, received_us, frame.utime, state); !done) return done;
    return model == nullptr ? success() : put_points(received_us, frame, positions);
  }

  Outcome status(std::int64_t received_us, const StatusMessage& s) override {
    Json stages = Json::array();
    for (const StageMessage& stage : s.stages)
      stages.push_back(
          {{"name", stage.name}, {"median_us", stage.median}, {"p99_us", stage.p99}, {"max_us", stage.max}});
    Json message = {{"utime", s.utime},
                    {"state", state_word(s.state)},
                    {"device", name_of(s.device)},
                    {"stream_fault", name_of(s.stream_fault)},
                    {"rate", s.rate},
                    {"strain_energy", s.strain_energy},
                    {"latency_median_us", s.latency_median},
                    {"latency_p99_us", s.latency_p99},
                    {"latency_max_us", s.latency_max}};
    for (const NamedCount& about : kStatusCounts) message[about.name] = s.*about.count;
    message["last_error"] = s.last_error;
    message["stages"] = stages;
    return put(status_, received_us, s.utime, message);
  }

  Outcome depth(std::int64_t received_us, const ReceivedDepth& picture) override {
    const Intrinsics& c = picture.camera;
    std::string bytes;
    bytes.reserve(picture.depth.size() * 2);
    for (const std::uint16_t reading : picture.depth) {
      bytes += static_cast<char>(reading & 0xFFU);
      bytes += static_cast<char>(reading >> 8U);
    }
    const Json stamp = time_of(picture.utime);
    if (Outcome done = put(depth_, received_us, picture.utime,
                           {{"timestamp", stamp},
                            {"frame_id", kCamera},
                            {"width", c.width},
                            {"height", c.height},
                            {"encoding", "16UC1"},
                            {"step", 2 * c.width},
                            {"data", base64(bytes)}});
        !done)
      return done;
    const std::vector<double> k = {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
    return put(camera_, received_us, picture.utime,
               {{"timestamp", stamp},
                {"frame_id", kCamera},
                {"width", c.width},
                {"height", c.height},
                {"distortion_model", ""},
                {"D", Json::array()},
                {"K", k},
                {"R", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                {"P", {c.fx, 0, c.cx, 0, 0, c.fy, c.cy, 0, 0, 0, 1, 0}}});
  }

  Outcome finish() override { return writer_.finish(); }
  [[nodiscard]] std::string summary() const override {
    return fmt::format("{} messages in {}", messages_, path_);
  }

 private:
  std::uint16_t channel(const char* topic, const char* name) {
    return writer_.add_channel(topic, writer_.add_schema(name, "jsonschema", message_schema(name)), "json");
  }

  Outcome put(std::uint16_t channel, std::int64_t received_us, std::int64_t utime, const Json& message) {
    ++messages_;
    // Texts come from the network: what is no UTF-8 is replaced.
    return writer_.write(channel, nanoseconds(received_us), nanoseconds(utime),
                         message.dump(-1, ' ', false, Json::error_handler_t::replace));
  }

  Outcome put_points(std::int64_t received_us, const ReceivedFrame& frame,
                     std::span<const Point3f> positions) {
    constexpr int kFloat32 = 7, kUint8 = 1, kInt8 = 2;
    constexpr std::size_t kStride = 21;
    std::string bytes;
    bytes.reserve(positions.size() * kStride);
    std::vector<float> strains(positions.size());
    for (std::size_t i = 0; i < frame.deformed.size(); ++i) {
      const auto index = static_cast<std::size_t>(frame.deformed[i]);
      if (index < strains.size()) strains[index] = frame.strain[i];
    }
    for (std::size_t i = 0; i < positions.size(); ++i) {
      put_float(bytes, positions[i].x);
      put_float(bytes, positions[i].y);
      put_float(bytes, positions[i].z);
      const RegionColour colour = region_colour(frame.labels[i]);
      // Points that were not seen are faint.
      const int alpha = frame.labels[i] == kNotObserved ? 60 : 255;
      for (const int value : {int{colour.red}, int{colour.green}, int{colour.blue}, alpha,
                              int{static_cast<std::uint8_t>(frame.labels[i])}})
        bytes += static_cast<char>(value);
      put_float(bytes, strains[i]);
    }
    const auto field = [](const char* name, int offset, int type) {
      return Json{{"name", name}, {"offset", offset}, {"type", type}};
    };
    return put(points_, received_us, frame.utime,
               {{"timestamp", time_of(frame.utime)},
                {"frame_id", kCamera},
                {"pose",
                 {{"position", {{"x", 0}, {"y", 0}, {"z", 0}}},
                  {"orientation", {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}}}},
                {"point_stride", kStride},
                {"fields",
                 {field("x", 0, kFloat32), field("y", 4, kFloat32), field("z", 8, kFloat32),
                  field("red", 12, kUint8), field("green", 13, kUint8), field("blue", 14, kUint8),
                  field("alpha", 15, kUint8), field("region", 16, kInt8), field("strain", 17, kFloat32)}},
                {"data", base64(bytes)}});
  }

  McapWriter writer_;
  std::string path_;
  std::uint16_t transforms_ = 0, points_ = 0, depth_ = 0, camera_ = 0, frames_ = 0, status_ = 0;
  std::int64_t messages_ = 0;
};

}  // namespace

Result<std::unique_ptr<LogExporter>> export_mcap(const std::string& path) {
  Result<McapWriter> writer = McapWriter::create(path, "pliant");
  if (!writer) return writer.error();
  return std::unique_ptr<LogExporter>(std::make_unique<FoxgloveExporter>(std::move(*writer), path));
}

}  // namespace pliant
