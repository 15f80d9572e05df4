// Memory that is there before the first frame.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "drivers/common/result.hpp"

namespace pliant {

/// One block of zeroed pages, aligned to a page, every page touched, and locked into memory where the user
/// may do so. Moves, does not copy.
class MemoryBlock {
 public:
  MemoryBlock() = default;
  MemoryBlock(MemoryBlock&& other) noexcept;
  MemoryBlock& operator=(MemoryBlock&& other) noexcept;
  ~MemoryBlock();

  /// ErrorKind::device when the system has not that much memory.
  [[nodiscard]] static Result<MemoryBlock> allocate(std::size_t bytes);

  [[nodiscard]] std::span<std::byte> bytes() noexcept { return {data_, size_}; }
  [[nodiscard]] bool locked() const noexcept { return locked_; }

 private:
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  bool locked_ = false;
};

/// Locks every page that the process holds or will ever touch into memory, so that none is fetched from a
/// disk again. Why not, with the mend, where the system refuses; empty when all is well.
[[nodiscard]] std::string lock_memory();

}  // namespace pliant
