// Hands groups of messages from one thread to another through slots of fixed size. Nobody waits: when all
// slots are full the oldest group gives way to the newest.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "drivers/lcm/track_messages.hpp"

namespace pliant {

class MessageRing {
 public:
  struct Group {
    std::span<const MessageBody> bodies;
    std::int64_t utime = 0;
  };

  /// Every slot holds up to `bodies` messages of together `bytes` bytes. At least three slots: one being
  /// sent, one being written and one to give way.
  MessageRing(std::size_t slots, std::size_t bodies, std::size_t bytes)
      : slots_(std::max<std::size_t>(slots, 3)) {
    for (Slot& slot : slots_) {
      slot.bytes.resize(bytes);
      slot.bodies.resize(bodies);
    }
  }

  /// Producer: copies the messages into a slot. False when they are larger than a slot.
  [[nodiscard]] bool push(std::span<const MessageBody> bodies, std::int64_t utime) noexcept {
    Slot* const slot = claim_for_writing();
    if (slot == nullptr) return false;
    std::size_t used = 0;
    bool fits = bodies.size() <= slot->bodies.size();
    for (std::size_t i = 0; fits && i < bodies.size(); ++i) {
      const auto& bytes = bodies[i].bytes;
      fits = bytes.size() <= slot->bytes.size() - used;
      if (!fits) break;
      if (!bytes.empty()) std::memcpy(slot->bytes.data() + used, bytes.data(), bytes.size());
      slot->bodies[i] = {bodies[i].kind,
                         std::span<const std::uint8_t>(slot->bytes).subspan(used, bytes.size())};
      used += bytes.size();
    }
    slot->count = fits ? bodies.size() : 0;
    slot->utime = utime;
    slot->state.store(fits ? filled(++sequence_) : kFree, std::memory_order_release);
    return fits;
  }

  /// Consumer: the oldest group, to be given back with release(); false when there is none.
  [[nodiscard]] bool take(Group& group) noexcept {
    for (std::size_t tries = 0; tries <= slots_.size(); ++tries) {
      std::uint64_t state = 0;
      Slot* const slot = oldest(state);
      if (slot == nullptr) return false;
      if (slot->state.compare_exchange_strong(state, kTaken, std::memory_order_acquire)) {
        taken_ = slot;
        group = {std::span<const MessageBody>(slot->bodies).first(slot->count), slot->utime};
        return true;
      }
    }
    return false;
  }
  void release() noexcept {
    if (taken_ != nullptr) taken_->state.store(kFree, std::memory_order_release);
    taken_ = nullptr;
  }

  /// Groups that were given up for newer ones.
  [[nodiscard]] std::int64_t gave_way() const noexcept { return gave_way_.load(std::memory_order_relaxed); }

 private:
  // A slot's state: free, in one thread's hands, or filled with a sequence number from 2 on.
  static constexpr std::uint64_t kFree = 0;
  static constexpr std::uint64_t kTaken = 1;
  static constexpr std::uint64_t filled(std::uint64_t sequence) noexcept { return sequence + 1; }

  struct Slot {
    std::atomic<std::uint64_t> state{kFree};
    std::vector<std::uint8_t> bytes;
    std::vector<MessageBody> bodies;
    std::size_t count = 0;
    std::int64_t utime = 0;
  };

  [[nodiscard]] Slot* oldest(std::uint64_t& state) noexcept {
    Slot* found = nullptr;
    for (Slot& slot : slots_) {
      const std::uint64_t seen = slot.state.load(std::memory_order_relaxed);
      if (seen > kTaken && (found == nullptr || seen < state)) {
        found = &slot;
        state = seen;
      }
    }
    return found;
  }

  /// A free slot, else the oldest filled one. Each failed exchange means that the consumer took that slot and
  /// so gave its former one back: the next look finds one.
  [[nodiscard]] Slot* claim_for_writing() noexcept {
    for (std::size_t tries = 0; tries <= slots_.size(); ++tries) {
      for (Slot& slot : slots_) {
        // Acquire: the consumer's reading of this slot is over.
        if (slot.state.load(std::memory_order_acquire) == kFree) {
          slot.state.store(kTaken, std::memory_order_relaxed);
          return &slot;
        }
      }
      std::uint64_t state = 0;
      Slot* const slot = oldest(state);
      if (slot != nullptr && slot->state.compare_exchange_strong(state, kTaken, std::memory_order_acquire)) {
        gave_way_.fetch_add(1, std::memory_order_relaxed);
        return slot;
      }
    }
    return nullptr;
  }

  std::vector<Slot> slots_;
  std::uint64_t sequence_ = 0;  // producer's
  Slot* taken_ = nullptr;       // consumer's
  std::atomic<std::int64_t> gave_way_{0};
};

}  // namespace pliant
