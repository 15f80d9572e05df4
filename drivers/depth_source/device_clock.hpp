// A device's own clock, brought to ours.
#pragma once

#include <cstdint>

namespace pliant {

/// The offset is measured: the least time seen between a frame's stamp and its arrival, let go slowly so that
/// it follows clocks that drift apart (by up to 100 µs a second within 10 ms).
class DeviceClock {
 public:
  /// Capture time on our clock of a frame stamped `device_us` that arrived at `arrival_us`, both
  /// microseconds.
  [[nodiscard]] std::int64_t to_ours(std::int64_t device_us, std::int64_t arrival_us) noexcept {
    const std::int64_t offset = arrival_us - device_us;
    if (!known_ || offset < offset_us_) {
      offset_us_ = offset;
      rest_ = 0;
      known_ = true;
    } else {
      rest_ += offset - offset_us_;
      offset_us_ += rest_ / kSlowness;
      rest_ %= kSlowness;
    }
    return device_us + offset_us_;
  }

 private:
  static constexpr std::int64_t kSlowness = 3000;  // frames
  std::int64_t offset_us_ = 0, rest_ = 0;
  bool known_ = false;
};

}  // namespace pliant
