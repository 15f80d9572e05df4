#include "firmware-app/export/foxglove_schemas.hpp"

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <utility>

namespace pliant {

namespace {

using Json = nlohmann::ordered_json;

Json object(std::initializer_list<std::pair<const char*, Json>> properties) {
  Json all = Json::object();
  for (const auto& [name, type] : properties) all[name] = type;
  return {{"type", "object"}, {"properties", all}};
}

const Json kNumber = {{"type", "number"}};
const Json kInteger = {{"type", "integer"}};
const Json kText = {{"type", "string"}};
const Json kBytes = {{"type", "string"}, {"contentEncoding", "base64"}};
const Json kTime = object({{"sec", kInteger}, {"nsec", kInteger}});
const Json kVector = object({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}});
const Json kVectorOrNone = {{"oneOf", {kVector, {{"type", "null"}}}}};
const Json kQuaternion = object({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}, {"w", kNumber}});

Json array_of(const Json& items) {
  return {{"type", "array"}, {"items", items}};
}

Json properties_of(std::string_view name) {
  if (name == "foxglove.FrameTransform") {
    return object({{"timestamp", kTime},
                   {"parent_frame_id", kText},
                   {"child_frame_id", kText},
                   {"translation", kVector},
                   {"rotation", kQuaternion}});
  }
  if (name == "foxglove.PointCloud") {
    const Json pose = object({{"position", kVector}, {"orientation", kQuaternion}});
    const Json field = object({{"name", kText}, {"offset", kInteger}, {"type", kInteger}});
    return object({{"timestamp", kTime},
                   {"frame_id", kText},
                   {"pose", pose},
                   {"point_stride", kInteger},
                   {"fields", array_of(field)},
                   {"data", kBytes}});
  }
  if (name == "foxglove.RawImage") {
    return object({{"timestamp", kTime},
                   {"frame_id", kText},
                   {"width", kInteger},
                   {"height", kInteger},
                   {"encoding", kText},
                   {"step", kInteger},
                   {"data", kBytes}});
  }
  if (name == "foxglove.CameraCalibration") {
    return object({{"timestamp", kTime},
                   {"frame_id", kText},
                   {"width", kInteger},
                   {"height", kInteger},
                   {"distortion_model", kText},
                   {"D", array_of(kNumber)},
                   {"K", array_of(kNumber)},
                   {"R", array_of(kNumber)},
                   {"P", array_of(kNumber)}});
  }
  if (name == "pliant.Frame") {
    const Json region = object({{"id", kInteger},
                                {"parent", kInteger},
                                {"points", kInteger},
                                {"rms", kNumber},
                                {"confidence", kNumber},
                                {"joint", kVectorOrNone}});
    return object({{"utime", kInteger},
                   {"frame", kInteger},
                   {"state", kText},
                   {"confidence", kNumber},
                   {"deformed", kInteger},
                   {"not_observed", kInteger},
                   {"regions", array_of(region)}});
  }
  if (name == "pliant.Status") {
    const Json stage =
        object({{"name", kText}, {"median_us", kInteger}, {"p99_us", kInteger}, {"max_us", kInteger}});
    return object({{"utime", kInteger},
                   {"state", kText},
                   {"device", kText},
                   {"rate", kNumber},
                   {"strain_energy", kNumber},
                   {"latency_median_us", kInteger},
                   {"latency_p99_us", kInteger},
                   {"latency_max_us", kInteger},
                   {"tracked", kInteger},
                   {"searching", kInteger},
                   {"lost", kInteger},
                   {"dropped", kInteger},
                   {"bad_frames", kInteger},
                   {"rss_bytes", kInteger},
                   {"last_error", kText},
                   {"stages", array_of(stage)}});
  }
  return object({});
}

}  // namespace

std::string message_schema(std::string_view name) {
  Json schema = properties_of(name);
  schema["title"] = name;
  return schema.dump();
}

}  // namespace pliant
