// Tells sound depth frames of a live stream from those that must not be tracked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "drivers/depth_source/device_state.hpp"

namespace pliant {

/// One stream at a time; restart() before the next. Makes no heap call. A frame is looked at whole for `zero`
/// and `stuck` and at every fourth row and column for `noise`: about 0.1 ms at 640×480.
class StreamJudge {
 public:
  /// `rate`: frames a second that the mode promises.
  StreamJudge(const Intrinsics& camera, const SensorDescription& sensor, double rate);

  /// A new stream begins; nothing of the one before counts.
  void restart() noexcept;

  /// The fault of a frame that arrived at `arrival_ns` (monotonic) and `arrival_us` (the clock of
  /// DepthFrame::utime). All but `none` and `slow` mean that it must not be used.
  [[nodiscard]] StreamFault judge(const DepthFrame& frame, std::int64_t arrival_ns,
                                  std::int64_t arrival_us) noexcept;

  /// Time between frames, ns: what the mode promises, or what a slow stream really keeps.
  [[nodiscard]] std::int64_t frame_time_ns() const noexcept { return frame_time_ns_; }
  /// Of the frames a second that the mode promises, the share that comes; 1 where the stream is not slow.
  [[nodiscard]] float rate_share() const noexcept {
    return static_cast<float>(promised_ns_) / static_cast<float>(frame_time_ns_);
  }

  /// A frame is delayed when it took longer to arrive than the quickest by this many frame times,
  static constexpr int kMostDelay = 3;
  /// or when it is older than this many, however quick the others were: one frame time for taking it, one for
  /// the way, and one for each of the kernel's four buffers. What is older was held back somewhere.
  static constexpr int kMostAge = 6;
  /// A stream is slow when its frames take this share of the promised time longer, in the median.
  static constexpr double kSlow = 1.5;

 private:
  struct Content {
    std::uint64_t hash = 0;
    bool zero = true;
  };
  [[nodiscard]] static Content read(const DepthFrame& frame) noexcept;
  [[nodiscard]] bool is_noise(const DepthFrame& frame) const noexcept;
  [[nodiscard]] bool is_delayed(const DepthFrame& frame, std::int64_t arrival_us) noexcept;
  void note_interval(std::int64_t arrival_ns) noexcept;

  static constexpr std::size_t kIntervals = 9;
  static constexpr std::size_t kToleranceSteps = 256;  // of 256 raw units each

  const int width_, height_;
  const std::int64_t promised_ns_;
  std::array<std::uint16_t, kToleranceSteps> tolerance_{};  // between neighbours of one surface, raw units
  std::int64_t frame_time_ns_;
  std::uint64_t hash_ = 0;
  bool hash_known_ = false;
  std::int64_t least_lag_us_ = 0;
  bool lag_known_ = false;
  std::int64_t last_arrival_ns_ = 0;
  std::array<std::int64_t, kIntervals> intervals_{};
  std::size_t interval_count_ = 0;
  bool slow_ = false;
};

}  // namespace pliant
