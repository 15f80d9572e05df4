// Tells who waits for a device that devices came or went.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace pliant {

/// Any thread notifies, any waits. Events between two waits are not lost.
class ArrivalSignal {
 public:
  void notify() {
    const std::lock_guard lock(mutex_);
    ++events_;
    changed_.notify_all();
  }
  [[nodiscard]] std::uint64_t events() const {
    const std::lock_guard lock(mutex_);
    return events_;
  }
  /// True as soon as there were more than `seen` events; false after `timeout`.
  [[nodiscard]] bool wait(std::uint64_t seen, std::chrono::nanoseconds timeout) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, timeout, [&] { return events_ > seen; });
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t events_ = 0;
};

}  // namespace pliant
