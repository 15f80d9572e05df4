#include "firmware-app/pipeline/frame_ring.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace pliant {

namespace {

std::size_t frame_pixels(const Intrinsics& camera) {
  return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
}

}  // namespace

std::size_t FrameRing::bytes(const Intrinsics& camera) {
  return frame_pixels(camera) * sizeof(std::uint16_t) * kSlots;
}

Result<MemoryBlock> FrameRing::allocate(const Intrinsics& camera) {
  return MemoryBlock::allocate(bytes(camera));
}

FrameRing::FrameRing(const Intrinsics& camera, Policy policy, MemoryBlock& memory) : policy_(policy) {
  auto* pixels = static_cast<std::uint16_t*>(static_cast<void*>(memory.bytes().data()));
  for (Slot& slot : slots_) {
    slot.pixels = pixels;
    slot.captured.frame = {pixels, camera.width, camera.height, camera.width, 0, 0};
    pixels += frame_pixels(camera);
  }
}

FrameRing::Slot* FrameRing::find(Use use, bool oldest) {
  Slot* found = nullptr;
  for (Slot& slot : slots_)
    if (slot.use == use && (found == nullptr || (slot.sequence < found->sequence) == oldest)) found = &slot;
  return found;
}

bool FrameRing::push(const DepthFrame& frame, std::int64_t arrival_ns) {
  std::unique_lock lock(mutex_);
  Slot* slot = find(Use::free, true);
  if (slot == nullptr && policy_ == Policy::newest) {
    slot = find(Use::queued, true);
    ++dropped_;
  }
  while (slot == nullptr && !closed_) {
    changed_.wait(lock);
    slot = find(Use::free, true);
  }
  if (closed_) return false;
  slot->use = Use::writing;
  lock.unlock();

  DepthFrame& copy = slot->captured.frame;
  copy.utime = frame.utime;
  copy.number = frame.number;
  slot->captured.arrival_ns = arrival_ns;
  const auto width = static_cast<std::size_t>(frame.width);
  for (int v = 0; v < frame.height; ++v)
    std::memcpy(slot->pixels + static_cast<std::size_t>(v) * width,
                frame.depth + static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.stride),
                width * sizeof(std::uint16_t));

  lock.lock();
  slot->use = Use::queued;
  slot->sequence = ++sequence_;
  changed_.notify_all();
  return true;
}

bool FrameRing::any(Use use) const {
  return std::any_of(slots_.begin(), slots_.end(), [use](const Slot& slot) { return slot.use == use; });
}

const CapturedFrame* FrameRing::pop(int timeout_ms) {
  std::unique_lock lock(mutex_);
  if (Slot* done = find(Use::reading, true); done != nullptr) {
    done->use = Use::free;
    changed_.notify_all();
  }
  const auto there = [this] { return closed_ || any(Use::queued); };
  if (timeout_ms < 0)
    changed_.wait(lock, there);
  else
    changed_.wait_for(lock, std::chrono::milliseconds(timeout_ms), there);
  Slot* slot = find(Use::queued, policy_ == Policy::keep_all);
  if (slot == nullptr) return nullptr;
  slot->use = Use::reading;
  if (policy_ == Policy::newest)
    for (Slot& other : slots_)
      if (other.use == Use::queued) {
        other.use = Use::free;
        ++dropped_;
      }
  return &slot->captured;
}

void FrameRing::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

void FrameRing::abort() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  for (Slot& slot : slots_)
    if (slot.use == Use::queued) slot.use = Use::free;
  changed_.notify_all();
}

bool FrameRing::ended() const {
  const std::lock_guard lock(mutex_);
  return closed_ && !any(Use::queued);
}

std::uint64_t FrameRing::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace pliant
