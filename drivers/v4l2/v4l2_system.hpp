// The system calls of the V4L2 driver, as an interface, so that tests can play the kernel and make each call
// fail.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pliant {

/// As the calls they are named after: -1 (or null) and errno where they fail.
class V4l2System {
 public:
  V4l2System() = default;
  V4l2System(const V4l2System&) = delete;
  V4l2System& operator=(const V4l2System&) = delete;
  virtual ~V4l2System() = default;
  /// Video nodes, in the order of their numbers.
  [[nodiscard]] virtual std::vector<std::string> nodes() = 0;
  /// For reading and writing, non-blocking; ENOTTY for what is no node of V4L2.
  [[nodiscard]] virtual int open(const char* path) = 0;
  virtual int close(int file) = 0;
  virtual int ioctl(int file, unsigned long request, void* argument) = 0;
  [[nodiscard]] virtual void* map(std::size_t length, int file, std::int64_t offset) = 0;
  virtual int unmap(void* memory, std::size_t length) = 0;
  /// Waits for something to read; what poll() returned in `events`.
  [[nodiscard]] virtual int poll(int file, int timeout_ms, short& events) = 0;
  /// Microseconds of CLOCK_MONOTONIC and CLOCK_REALTIME.
  [[nodiscard]] virtual std::int64_t monotonic_us() = 0;
  [[nodiscard]] virtual std::int64_t wall_us() = 0;
};

/// The kernel.
[[nodiscard]] V4l2System& kernel_v4l2();

}  // namespace pliant
