// What a live source tells of its device while it runs.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "drivers/depth_source/device_state.hpp"

namespace pliant {

/// Written by the thread that uses the source, read by any.
class DeviceMonitor {
 public:
  [[nodiscard]] DeviceState state() const noexcept { return state_.load(std::memory_order_relaxed); }
  /// Of the latest frame.
  [[nodiscard]] StreamFault fault() const noexcept { return fault_.load(std::memory_order_relaxed); }
  /// Share of the frames a second that the mode promises which really come; 1 where the stream is not slow.
  [[nodiscard]] float rate_share() const noexcept { return rate_share_.load(std::memory_order_relaxed); }
  /// No sound frame for three frame times: what was seen last need not hold any more.
  [[nodiscard]] bool blind() const noexcept { return blind_.load(std::memory_order_relaxed); }
  /// Frames with this fault.
  [[nodiscard]] std::int64_t frames(StreamFault fault) const noexcept {
    return frames_[static_cast<std::size_t>(fault)].load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::int64_t stalls() const noexcept { return stalls_.load(std::memory_order_relaxed); }
  /// Times that the device was opened after the first.
  [[nodiscard]] std::int64_t reopenings() const noexcept {
    return reopenings_.load(std::memory_order_relaxed);
  }

  void set_state(DeviceState state) noexcept { state_.store(state, std::memory_order_relaxed); }
  void judged(StreamFault fault) noexcept {
    fault_.store(fault, std::memory_order_relaxed);
    frames_[static_cast<std::size_t>(fault)].fetch_add(1, std::memory_order_relaxed);
  }
  void set_rate_share(float share) noexcept { rate_share_.store(share, std::memory_order_relaxed); }
  void set_blind(bool blind) noexcept { blind_.store(blind, std::memory_order_relaxed); }
  void stalled() noexcept { stalls_.fetch_add(1, std::memory_order_relaxed); }
  void reopened() noexcept { reopenings_.fetch_add(1, std::memory_order_relaxed); }

 private:
  std::atomic<DeviceState> state_{DeviceState::absent};
  std::atomic<StreamFault> fault_{StreamFault::none};
  std::atomic<float> rate_share_{1};
  std::atomic<bool> blind_{true};
  std::array<std::atomic<std::int64_t>, kStreamFaults> frames_{};
  std::atomic<std::int64_t> stalls_{0}, reopenings_{0};
};

}  // namespace pliant
