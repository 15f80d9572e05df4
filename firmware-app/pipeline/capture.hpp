// The capture thread's work: frames from the source into the ring.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "drivers/depth_source/depth_source.hpp"
#include "firmware-app/pipeline/frame_ring.hpp"

namespace pliant {

class Capture {
 public:
  struct Settings {
    bool pace_by_stamps = false;    ///< hold frames back until their stamps are due
    std::int64_t frame_limit = -1;  ///< frames to take from the source, bad ones included; -1 for all
  };
  Capture(DepthSource& source, FrameRing& ring, const Settings& settings)
      : source_(source), ring_(ring), settings_(settings) {}

  /// Until the source ends, is lost, the limit is reached or stop() is called; then closes the ring.
  void run();
  void stop() noexcept { stop_.store(true, std::memory_order_relaxed); }

  /// From the source, bad ones included.
  [[nodiscard]] std::int64_t taken() const noexcept { return taken_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::int64_t bad_frames() const noexcept {
    return bad_frames_.load(std::memory_order_relaxed);
  }
  /// As the source's monitor says, and for a source without one: opening, streaming, ended.
  [[nodiscard]] DeviceState device() const noexcept;
  /// Null where the source watches no device.
  [[nodiscard]] const DeviceMonitor* monitor() const noexcept { return source_.monitor(); }
  /// Grows with every answer of the source: a frame, or, from a live one, that none has come yet.
  [[nodiscard]] std::uint64_t beats() const noexcept { return beats_.load(std::memory_order_relaxed); }
  /// The latest fault, in one line; empty when there was none. Copied without a heap call.
  void copy_fault(std::span<char> text) const noexcept;
  [[nodiscard]] std::string fault() const;

 private:
  void wait_until_due(std::int64_t utime);
  void note_fault(const std::string& fault);
  [[nodiscard]] bool stopped() const noexcept { return stop_.load(std::memory_order_relaxed); }

  DepthSource& source_;
  FrameRing& ring_;
  const Settings settings_;
  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> taken_{0}, bad_frames_{0};
  std::atomic<std::uint64_t> beats_{0};
  std::atomic<DeviceState> device_{DeviceState::opening};
  mutable std::mutex mutex_;
  std::array<char, 256> fault_{};
  std::int64_t first_utime_ = 0, first_ns_ = 0;
  bool first_seen_ = false;
};

}  // namespace pliant
