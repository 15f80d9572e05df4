#include "firmware-app/viewer/packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "drivers/geometry_files/region_colours.hpp"
#include "firmware-app/outputs/status_counts.hpp"
#include "firmware-app/outputs/words.hpp"
#include "firmware-app/pictures/displacement_colours.hpp"
#include "firmware-app/viewer/stream.hpp"

namespace pliant::viewer {

namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "arrays are sent as they lie in memory");

template <typename Value>
void put(Bytes& bytes, const Value* values, std::size_t count) {
  const std::size_t at = bytes.size();
  bytes.resize((at + count * sizeof(Value) + 3) / 4 * 4);
  if (count > 0) std::memcpy(bytes.data() + at, values, count * sizeof(Value));
}

Bytes packet(PacketKind kind, const Json& header) {
  // Texts come from the network: what is no UTF-8 is replaced.
  std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  Bytes bytes;
  const std::uint32_t start[2] = {static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(text.size())};
  put(bytes, start, 2);
  put(bytes, text.data(), text.size());
  return bytes;
}

/// JavaScript's numbers hold 53 bits.
std::string id_text(std::int64_t id) {
  return fmt::format("{:016x}", static_cast<std::uint64_t>(id));
}

Json colour(const RegionColour& c) {
  return {c.red, c.green, c.blue};
}

/// Null where a region hangs on nothing.
Json joint_of(const RegionMessage& region) {
  if (!region.joint) return nullptr;
  return {region.joint->x, region.joint->y, region.joint->z};
}

std::int8_t eight_bits(float unit) {
  return static_cast<std::int8_t>(std::lround(std::clamp(unit, -1.0F, 1.0F) * 127.0F));
}

}  // namespace

Bytes link_packet(const Link& link) {
  return packet(PacketKind::link, {{"url", link.url},
                                   {"prefix", link.prefix},
                                   {"fault", link.fault},
                                   {"others", link.others},
                                   {"incomplete", link.incomplete},
                                   {"advice", link.advice}});
}

Bytes status_packet(const StatusMessage& s) {
  Json stages = Json::array();
  for (const StageMessage& stage : s.stages)
    stages.push_back(
        {{"name", stage.name}, {"median", stage.median}, {"p99", stage.p99}, {"max", stage.max}});
  Json header = {{"version", s.version},
                 {"source", s.source},
                 {"frame", s.frame},
                 {"state", state_word(s.state)},
                 {"device", name_of(s.device)},
                 {"stream_fault", name_of(s.stream_fault)},
                 {"rate", s.rate},
                 {"strain_energy", s.strain_energy},
                 {"latency_median", s.latency_median},
                 {"latency_p99", s.latency_p99},
                 {"latency_max", s.latency_max},
                 {"stages", stages},
                 {"last_error", s.last_error}};
  for (const NamedCount& about : kStatusCounts) header[about.name] = s.*about.count;
  return packet(PacketKind::status, header);
}

Bytes model_packet(const ReceivedModel& model) {
  Point3f low{1e9F, 1e9F, 1e9F}, high{-1e9F, -1e9F, -1e9F};
  for (const Point3f& p : model.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Point3f centre{(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
  float radius = 1e-3F;
  for (const Point3f& p : model.points)
    radius = std::max(radius, std::hypot(p.x - centre.x, p.y - centre.y, p.z - centre.z));
  Json palette = Json::array();
  for (int label = kNotObserved; label < 32; ++label) palette.push_back(colour(region_colour(label)));
  Json displacement = Json::array();
  constexpr int kSteps = 32;
  for (int step = 0; step < kSteps; ++step)
    displacement.push_back(colour(displacement_colour(step, kSteps - 1)));
  Bytes bytes = packet(PacketKind::model, {{"model_id", id_text(model.model_id)},
                                           {"points", model.points.size()},
                                           {"spacing", model.spacing},
                                           {"centre", {centre.x, centre.y, centre.z}},
                                           {"radius", radius},
                                           {"palette", palette},
                                           {"displacement", displacement}});
  put(bytes, model.points.data(), model.points.size());
  std::vector<std::int8_t> normals;
  normals.reserve(3 * model.normals.size());
  for (const Point3f& n : model.normals)
    for (const float value : {n.x, n.y, n.z}) normals.push_back(eight_bits(value));
  put(bytes, normals.data(), normals.size());
  return bytes;
}

Bytes frame_packet(const ReceivedFrame& frame) {
  Json regions = Json::array();
  for (const RegionMessage& r : frame.regions)
    regions.push_back({{"id", r.id},
                       {"parent", r.parent},
                       {"points", r.points},
                       {"rms", r.rms},
                       {"confidence", r.confidence},
                       {"trans", r.trans},
                       {"quat", r.quat},
                       {"joint", joint_of(r)}});
  std::vector<float> lengths, moved;
  for (std::size_t i = 0; i < frame.deformed.size(); ++i) {
    const Point3f& p = frame.position[i];
    const Point3f& d = frame.displacement[i];
    lengths.push_back(std::hypot(d.x, d.y, d.z));
    moved.insert(moved.end(), {p.x, p.y, p.z, lengths.back()});
  }
  Bytes bytes = packet(PacketKind::frame,
                       {{"model_id", id_text(frame.model_id)},
                        {"frame", frame.frame},
                        {"utime", frame.utime},
                        {"state", state_word(frame.state)},
                        {"confidence", frame.confidence},
                        {"regions", regions},
                        {"points", frame.labels.size()},
                        {"deformed", frame.deformed.size()},
                        {"not_observed", std::count(frame.labels.begin(), frame.labels.end(), kNotObserved)},
                        {"scale", displacement_scale(lengths)}});
  put(bytes, frame.labels.data(), frame.labels.size());
  put(bytes, moved.data(), moved.size());
  put(bytes, frame.deformed.data(), frame.deformed.size());
  return bytes;
}

Bytes depth_packet(const ReceivedDepth& depth) {
  const Intrinsics& c = depth.camera;
  constexpr int kMostColumns = 214;  // a third of VGA: a quarter of a megabit a picture
  const int step = std::max(1, (c.width + kMostColumns - 1) / kMostColumns);
  const int columns = (c.width + step - 1) / step, rows = (c.height + step - 1) / step;
  std::vector<std::uint16_t> readings;
  readings.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int v = 0; v < c.height; v += step)
    for (int u = 0; u < c.width; u += step)
      readings.push_back(depth.depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(c.width) +
                                     static_cast<std::size_t>(u)]);
  std::vector<std::uint16_t> sorted;
  for (const std::uint16_t reading : readings)
    if (reading != 0) sorted.push_back(reading);
  std::sort(sorted.begin(), sorted.end());
  const double near = sorted.empty() ? 0 : sorted[sorted.size() / 50] / c.depth_scale;
  const double far = sorted.empty() ? 1 : sorted[sorted.size() - 1 - sorted.size() / 20] / c.depth_scale;
  Bytes bytes = packet(PacketKind::depth, {{"frame", depth.frame},
                                           {"columns", columns},
                                           {"rows", rows},
                                           {"step", step},
                                           {"fx", c.fx},
                                           {"fy", c.fy},
                                           {"cx", c.cx},
                                           {"cy", c.cy},
                                           {"depth_scale", c.depth_scale},
                                           {"near", near},
                                           {"far", far}});
  put(bytes, readings.data(), readings.size());
  return bytes;
}

}  // namespace pliant::viewer
