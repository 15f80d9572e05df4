// Time from a frame's arrival to its messages' hand-over to the network.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>

#include "firmware-app/measure/histogram.hpp"

namespace pliant {

/// The tracking thread says when a frame arrived, the sending thread when its messages are out. No heap.
class LatencyMeter {
 public:
  /// A frame is known by its capture time.
  void arrived(std::int64_t utime, std::int64_t arrival_ns) noexcept;
  void sent(std::int64_t utime) noexcept;

  /// Over the whole run.
  [[nodiscard]] Histogram whole() const noexcept;
  /// Median, p99 and maximum since the last call, ns.
  [[nodiscard]] std::array<std::int64_t, 3> take_recent() noexcept;

 private:
  struct Mark {
    std::int64_t utime = -1, arrival_ns = 0;
  };
  mutable std::mutex mutex_;
  std::array<Mark, 16> marks_{};  // more than frames can wait to be sent
  std::size_t next_ = 0;
  Histogram whole_, recent_;
};

}  // namespace pliant
