// How a depth device and its stream fare.
#pragma once

#include <cstdint>

namespace pliant {

/// State of a depth device, numbered as in status_t.
enum class DeviceState : std::uint8_t {
  absent,     ///< no such device is plugged in
  opening,    ///< opened, no frame yet
  streaming,  ///< frames come
  stalled,    ///< no frame for three frame times
  lost,       ///< gone, or given up after a stall
  reopening,  ///< there, but not open (again) yet; tried with growing pauses
  ended       ///< closed: the source is at its end, or the run was stopped
};

/// What is wrong with a stream whose frames come, numbered as in status_t.
enum class StreamFault : std::uint8_t {
  none,
  zero,        ///< no reading in the whole frame
  stuck,       ///< the same readings as in the frame before, to the last bit
  noise,       ///< readings that are not a surface anywhere
  wrong_size,  ///< not the camera's size
  delayed,     ///< taken long before it arrived
  slow,        ///< sound, but fewer frames than the mode promises; tracked, with less confidence
  broken       ///< the driver says that the frame is not whole
};
inline constexpr int kStreamFaults = 8;

/// "absent", "opening", …
[[nodiscard]] constexpr const char* name_of(DeviceState state) noexcept {
  constexpr const char* kNames[] = {"absent", "opening",   "streaming", "stalled",
                                    "lost",   "reopening", "ended"};
  return kNames[static_cast<int>(state)];
}

/// "none", "zero", …
[[nodiscard]] constexpr const char* name_of(StreamFault fault) noexcept {
  constexpr const char* kNames[] = {"none",       "zero",    "stuck", "noise",
                                    "wrong_size", "delayed", "slow",  "broken"};
  return kNames[static_cast<int>(fault)];
}

}  // namespace pliant
