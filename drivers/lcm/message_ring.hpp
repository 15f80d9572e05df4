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
    std::size_t needed = 0;
    for (const MessageBody& body : bodies) needed += body.bytes.size();
    if (bodies.size() > slots_.front().bodies.size() || needed > slots_.front().bytes.size()) return false;

    std::uint64_t sequence = head_.load(std::memory_order_relaxed) + 1;
    while (!claim_for_writing(slot_of(sequence))) ++sequence;
    Slot& slot = slot_of(sequence);
    std::size_t used = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto& bytes = bodies[i].bytes;
      if (!bytes.empty()) std::memcpy(slot.bytes.data() + used, bytes.data(), bytes.size());
      slot.bodies[i] = {bodies[i].kind,
                        std::span<const std::uint8_t>(slot.bytes).subspan(used, bytes.size())};
      used += bytes.size();
    }
    slot.count = bodies.size();
    slot.utime = utime;
    slot.state.store(filled(sequence), std::memory_order_release);
    head_.store(sequence, std::memory_order_release);
    return true;
  }

  /// Consumer: the oldest group, to be given back with release(); false when there is none.
  [[nodiscard]] bool take(Group& group) noexcept {
    const std::uint64_t head = head_.load(std::memory_order_acquire);
    const std::uint64_t count = slots_.size();
    for (next_ = std::max(next_, head < count ? 1 : head - count + 1); next_ <= head;) {
      Slot& slot = slot_of(next_);
      std::uint64_t expected = filled(next_++);
      // Fails where that number was passed over or its group gave way.
      if (slot.state.compare_exchange_strong(expected, kTaken, std::memory_order_acquire,
                                             std::memory_order_relaxed)) {
        taken_ = &slot;
        group = {std::span<const MessageBody>(slot.bodies).first(slot.count), slot.utime};
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
  // A slot's state: free, in one thread's hands, or filled with the group of a number. Group number n stands
  // in slot n modulo their count, numbers from 1 on.
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
  [[nodiscard]] Slot& slot_of(std::uint64_t sequence) noexcept {
    return slots_[static_cast<std::size_t>(sequence % slots_.size())];
  }

  /// False where the consumer has the slot. It has one at a time and only takes filled ones, so trying one
  /// slot after the other ends within one round.
  [[nodiscard]] bool claim_for_writing(Slot& slot) noexcept {
    // Acquire: the consumer's reading of this slot is over.
    std::uint64_t state = slot.state.load(std::memory_order_acquire);
    if (state == kTaken) return false;
    if (state == kFree) {
      slot.state.store(kTaken, std::memory_order_relaxed);
      return true;
    }
    if (!slot.state.compare_exchange_strong(state, kTaken, std::memory_order_acquire,
                                            std::memory_order_relaxed)) {
      return false;
    }
    gave_way_.fetch_add(1, std::memory_order_relaxed);
    return true;
  }

  std::vector<Slot> slots_;
  std::atomic<std::uint64_t> head_{0};  // number of the newest group
  std::uint64_t next_ = 1;              // consumer's: the number it looks for
  Slot* taken_ = nullptr;               // consumer's
  std::atomic<std::int64_t> gave_way_{0};
};

}  // namespace pliant
