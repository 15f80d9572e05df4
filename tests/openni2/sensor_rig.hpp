// The virtual sensor, as tests see it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "drivers/depth_source/depth_source.hpp"
#include "tests/openni2/virtual_sensor.hpp"
#include "tests/temporary_folder.hpp"

namespace pliant::test {

/// Plays the first frames of a simulated source; while it lives the environment names its memory. The folder
/// is removed at the end.
class SensorRig {
 public:
  explicit SensorRig(const std::string& simulated = "simulated:box?width=320&height=240&frames=20");
  ~SensorRig();
  SensorRig(const SensorRig&) = delete;
  SensorRig& operator=(const SensorRig&) = delete;
  [[nodiscard]] SensorControl& control() const { return *control_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] const std::uint16_t* frame(int index) const;
  /// Records `frames` frames with the library's own recorder.
  void record_oni(const std::filesystem::path& file, int frames) const;

 private:
  const TemporaryFolder folder_;
  SensorControl* control_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace pliant::test
