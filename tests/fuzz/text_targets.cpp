#include <cmath>
#include <string_view>

#include "drivers/recording/camera_file.hpp"
#include "drivers/recording/depth_list.hpp"
#include "firmware-app/config/config.hpp"
#include "firmware-app/config/sensor_file.hpp"
#include "tests/fuzz/promises.hpp"
#include "tests/fuzz/targets.hpp"

namespace pliant {

namespace {

std::string_view text_of(Bytes data) {
  return {static_cast<const char*>(static_cast<const void*>(data.data())), data.size()};
}

void check_camera(const Intrinsics& camera) {
  promise(intrinsics_fault(camera) == nullptr, "an accepted camera is sound");
}

}  // namespace

void fuzz_camera(Bytes data) {
  const Result<CameraFile> camera = parse_camera(text_of(data), "file");
  if (!camera) {
    check_error(camera.error());
    return;
  }
  check_camera(camera->intrinsics);
  const Result<CameraFile> again = parse_camera(camera_text(*camera), "file");
  promise(static_cast<bool>(again), "what is written can be read");
  promise(again->intrinsics.fx == camera->intrinsics.fx &&
              again->sensor.noise_floor == camera->sensor.noise_floor,
          "the values come back");
}

void fuzz_config(Bytes data) {
  Config config;
  if (const Outcome parsed = parse_config(text_of(data), "file", config); !parsed) {
    check_error(parsed.error());
    return;
  }
  promise(config.track.max_regions >= 1 && config.track.max_regions <= 8, "ranges are kept");
  promise(std::isfinite(config.track.budget_ms) && std::isfinite(config.track.material.value_or(0)),
          "numbers are finite");
  promise(config.view.port >= 0 && config.view.port <= 65535, "the port is one");
  promise(!describe_config(config).empty(), "a config can be described");
}

void fuzz_sensor(Bytes data) {
  SensorFile sensor;
  if (const Outcome parsed = parse_sensor(text_of(data), "file", sensor); !parsed) {
    check_error(parsed.error());
    return;
  }
  check_camera(sensor.intrinsics());
}

void fuzz_depth_list(Bytes data) {
  const Result<std::vector<DepthListEntry>> list = parse_depth_list(text_of(data), "file", "/recording");
  if (!list) {
    check_error(list.error());
    return;
  }
  promise(!list->empty(), "a list has frames");
  promise(list->size() <= data.size(), "no more than the bytes hold");
  for (const DepthListEntry& entry : *list) {
    promise(entry.utime >= 0, "stamps are not negative");
    promise(!entry.file.empty() && entry.file.front() != '/', "files are relative");
    promise(entry.file.rfind("../", 0) != 0 && entry.file.find("/../") == std::string::npos,
            "files stay inside");
  }
}

}  // namespace pliant
