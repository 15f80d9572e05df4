// One block of memory, handed out once at start-up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace pliant {

/// Hands out parts of one caller-owned block, front to back, never back again. A measuring workspace has no
/// block: it hands out empty spans and counts what a real one would need, so that the layout and its size are
/// one piece of code.
class Workspace {
 public:
  static constexpr std::size_t kAlignment = 64;  ///< bytes; a cache line

  /// Measures only.
  constexpr Workspace() noexcept = default;
  /// Hands out `block`, which must be aligned to kAlignment and outlive all that is taken from it.
  explicit Workspace(std::span<std::byte> block) noexcept : block_(block.data()), size_(block.size()) {}

  /// `count` objects of T, uninitialised, aligned to a cache line. Empty when measuring or when the block is
  /// exhausted (see exhausted()).
  template <typename T>
  [[nodiscard]] std::span<T> take(std::size_t count) noexcept {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kAlignment);
    const std::size_t begin = used_;
    used_ += (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    if (block_ == nullptr || used_ > size_) {
      exhausted_ = exhausted_ || block_ != nullptr;
      return {};
    }
    return {static_cast<T*>(static_cast<void*>(block_ + begin)), count};
  }

  /// Bytes taken so far, gaps for alignment included.
  [[nodiscard]] std::size_t used() const noexcept { return used_; }
  /// More was taken than the block holds.
  [[nodiscard]] bool exhausted() const noexcept { return exhausted_; }
  [[nodiscard]] bool measuring() const noexcept { return block_ == nullptr; }

 private:
  std::byte* block_ = nullptr;
  std::size_t size_ = 0;
  std::size_t used_ = 0;
  bool exhausted_ = false;
};

}  // namespace pliant
