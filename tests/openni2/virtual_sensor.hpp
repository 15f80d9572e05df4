// What a test tells the virtual sensor, through memory that both map from the file named in the environment.
#pragma once

#include <atomic>
#include <cstdint>

namespace pliant::test {

inline constexpr const char* kVirtualSensorVariable = "PLIANT_VIRTUAL_SENSOR";

enum class SensorFault : std::int32_t {
  none,
  silent,              ///< no frames
  stuck,               ///< the same frame again and again
  noise,               ///< random readings
  zero,                ///< no reading at all
  slow,                ///< a quarter of the promised rate
  delayed,             ///< stamped half a second before they come
  wrong_size,          ///< frames smaller than the mode
  cut,                 ///< frames with fewer bytes than their size needs
  keeps_mirror,        ///< mirroring cannot be switched off
  keeps_registration,  ///< to colour, which it takes for switched off
  other_mode,          ///< takes a mode and sets another
  no_start             ///< the stream does not start
};

/// The frames to play follow behind it: `frames` pictures of width x height readings.
struct SensorControl {
  std::atomic<std::int32_t> plugged{1};
  std::atomic<SensorFault> fault{SensorFault::none};
  std::int32_t width = 320, height = 240, frames = 0;
  std::int32_t rate = 30;
  float field_of_view_across = 1.0225F, field_of_view_down = 0.7966F;  ///< radians
  std::atomic<std::int32_t> sent{0};                                   ///< frames handed to the library
  std::atomic<std::int32_t> unplugged{0};                              ///< plug and unplug events raised
};
static_assert(sizeof(SensorControl) % 2 == 0 && std::atomic<std::int32_t>::is_always_lock_free);

}  // namespace pliant::test
