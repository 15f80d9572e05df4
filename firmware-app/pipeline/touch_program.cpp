#include "firmware-app/pipeline/touch_program.hpp"

#include <link.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

namespace pliant {

namespace {

/// Sanitizers guard the gaps between variables, which are read here as well.
__attribute__((no_sanitize("address", "thread", "undefined"))) std::size_t touch(std::uintptr_t begin,
                                                                                 std::uintptr_t end,
                                                                                 bool write) noexcept {
  static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  std::size_t bytes = 0;
  for (std::uintptr_t at = begin & ~(page - 1); at < end; at += page, bytes += page) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader tells addresses as numbers
    auto* byte = reinterpret_cast<unsigned char*>(std::max(at, begin));
    if (write)
      __atomic_fetch_or(byte, static_cast<unsigned char>(0),
                        __ATOMIC_RELAXED);  // others may be writing there
    else
      static_cast<void>(*static_cast<const volatile unsigned char*>(byte));
  }
  return bytes;
}

int touch_object(dl_phdr_info* object, std::size_t /*size*/, void* sum) noexcept {
  // What the loader has made read-only after its work.
  std::uintptr_t sealed_begin = 0, sealed_end = 0;
  for (int i = 0; i < object->dlpi_phnum; ++i)
    if (const auto& header = object->dlpi_phdr[i]; header.p_type == PT_GNU_RELRO) {
      sealed_begin = object->dlpi_addr + header.p_vaddr;
      sealed_end = sealed_begin + header.p_memsz;
    }
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& header = object->dlpi_phdr[i];
    if (header.p_type != PT_LOAD || (header.p_flags & PF_R) == 0) continue;
    const std::uintptr_t begin = object->dlpi_addr + header.p_vaddr, end = begin + header.p_memsz;
    const bool writable = (header.p_flags & PF_W) != 0;
    std::uintptr_t first = begin;
    if (writable && sealed_begin >= begin && sealed_end > begin)
      first = std::min(std::max(begin, sealed_end), end);
    *static_cast<std::size_t*>(sum) += touch(first, end, writable);
  }
  return 0;
}

}  // namespace

std::size_t touch_program() noexcept {
  std::size_t sum = 0;
  dl_iterate_phdr(&touch_object, &sum);
  return sum;
}

}  // namespace pliant
