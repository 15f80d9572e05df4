// A live source that plays pictures drawn beforehand, forward and backward without end, with every fault that
// a device is known for, each at its own period.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/depth_source/depth_source.hpp"

namespace pliant::soak {

class FaultySource final : public DepthSource {
 public:
  /// Draws `pictures` frames of a simulated source. `seen` grows with every frame that tracking has seen: the
  /// source waits for it, but for bursts, so that no frame is dropped without need.
  [[nodiscard]] static Result<std::vector<std::vector<std::uint16_t>>> draw(const std::string& uri,
                                                                            int pictures, Intrinsics& camera);
  FaultySource(std::vector<std::vector<std::uint16_t>> pictures, const Intrinsics& camera,
               std::int64_t frames, const std::atomic<std::int64_t>& seen);

  [[nodiscard]] const Intrinsics& intrinsics() const override { return camera_; }
  [[nodiscard]] const SensorDescription& sensor() const override { return sensor_; }
  [[nodiscard]] bool live() const override { return true; }
  void next(int timeout_ms, SourceItem& item) override;
  void close() override {}

  /// Frames given, bad ones included. After the run.
  [[nodiscard]] std::int64_t given() const { return number_; }

 private:
  void wait_for_tracking() const;
  [[nodiscard]] const std::vector<std::uint16_t>& picture(std::int64_t number) const;

  std::vector<std::vector<std::uint16_t>> pictures_;
  std::vector<std::uint16_t> empty_, wall_, noise_;
  Intrinsics camera_;
  SensorDescription sensor_;
  std::int64_t frames_;
  const std::atomic<std::int64_t>& seen_;
  std::int64_t number_ = 0;
  std::int64_t seen_before_ = 0;
  std::int64_t silent_at_ = -1;
  bool wait_ = false;
};

}  // namespace pliant::soak
