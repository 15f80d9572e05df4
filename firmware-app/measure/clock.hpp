// The monotonic clock.
#pragma once

#include <cstdint>
#include <ctime>

namespace pliant {

/// Nanoseconds since some fixed moment; never goes back.
inline std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Sleeps until monotonic_ns() is `when`; a signal may end it early.
inline void sleep_until_ns(std::int64_t when) {
  const timespec until{static_cast<std::time_t>(when / 1'000'000'000),
                       static_cast<long>(when % 1'000'000'000)};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

}  // namespace pliant
