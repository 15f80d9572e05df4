// The ring of frames between capture and tracking.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "firmware-app/pipeline/memory_block.hpp"

namespace pliant {

struct CapturedFrame {
  DepthFrame frame;
  std::int64_t arrival_ns = 0;  ///< monotonic_ns() when the frame was there
};

/// Fixed slots, allocated and touched before the first frame. One thread pushes, one pops; no heap call in
/// either.
class FrameRing {
 public:
  enum class Policy : std::uint8_t {
    keep_all,  ///< push() waits for a free slot: no frame is lost
    newest     ///< push() never waits and pop() takes the newest; older frames are dropped and counted
  };
  /// Of all slots.
  [[nodiscard]] static std::size_t bytes(const Intrinsics& camera);
  [[nodiscard]] static Result<MemoryBlock> allocate(const Intrinsics& camera);
  /// `memory` comes from allocate() with the same camera and must outlive the ring.
  FrameRing(const Intrinsics& camera, Policy policy, MemoryBlock& memory);

  /// Copies a frame of the camera's size in. False when the ring was closed.
  bool push(const DepthFrame& frame, std::int64_t arrival_ns);
  /// The next frame, waiting for one, at most `timeout_ms` where that is not negative; null when none came in
  /// that time or the ring ended(). Valid until the next pop().
  [[nodiscard]] const CapturedFrame* pop(int timeout_ms = -1);
  /// Closed and empty.
  [[nodiscard]] bool ended() const;
  /// No more frames come; those in the ring can still be taken.
  void close();
  /// Ends at once: what is in the ring is thrown away and not counted as dropped.
  void abort();
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  static constexpr std::size_t kSlots = 4;
  enum class Use : std::uint8_t { free, writing, queued, reading };
  struct Slot {
    CapturedFrame captured;
    std::uint16_t* pixels = nullptr;
    Use use = Use::free;
    std::uint64_t sequence = 0;
  };
  [[nodiscard]] Slot* find(Use use, bool oldest);
  [[nodiscard]] bool any(Use use) const;

  const Policy policy_;
  std::array<Slot, kSlots> slots_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t sequence_ = 0;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace pliant
