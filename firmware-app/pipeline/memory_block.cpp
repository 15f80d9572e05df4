#include "firmware-app/pipeline/memory_block.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace pliant {

MemoryBlock::MemoryBlock(MemoryBlock&& other) noexcept {
  *this = std::move(other);
}

MemoryBlock& MemoryBlock::operator=(MemoryBlock&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(locked_, other.locked_);
  return *this;
}

MemoryBlock::~MemoryBlock() {
  if (data_ != nullptr) munmap(data_, size_);
}

Result<MemoryBlock> MemoryBlock::allocate(std::size_t bytes) {
  MemoryBlock block;
  if (bytes == 0) return block;
  void* got = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (got == MAP_FAILED)
    return Error{ErrorKind::device, fmt::format("cannot get {:.1f} MB of memory: {}",
                                                static_cast<double>(bytes) / 1e6, std::strerror(errno))};
  block.data_ = static_cast<std::byte*>(got);
  block.size_ = bytes;
  std::memset(got, 0, bytes);
  block.locked_ = mlock(got, bytes) == 0;
  return block;
}

std::string lock_memory() {
  // On fault: what is never touched, such as the far ends of stacks, takes no memory.
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return "";
  return fmt::format(
      "memory is not locked ({}); run as root or raise the memlock limit (ulimit -l unlimited)",
      std::strerror(errno));
}

}  // namespace pliant
