// The clocks of the kernel as drivers stamp with them.
#pragma once

#include <cstdint>
#include <ctime>

namespace pliant {

/// Now on `clock`, microseconds since its zero (CLOCK_REALTIME: the epoch; CLOCK_MONOTONIC: the start).
[[nodiscard]] inline std::int64_t clock_us(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
}

}  // namespace pliant
