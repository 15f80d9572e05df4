#include "tests/lcm/heap_counter.hpp"

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PLIANT_COUNTS_HEAP 0
#elif defined(__has_feature)
#define PLIANT_COUNTS_HEAP (!__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer))
#else
#define PLIANT_COUNTS_HEAP 1
#endif

namespace {
thread_local std::int64_t calls = 0;
}  // namespace

#if PLIANT_COUNTS_HEAP
// glibc lets a program replace these for itself and every library it loads.
// NOLINTBEGIN(bugprone-reserved-identifier): glibc's own names
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++calls;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++calls;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  ++calls;
  return __libc_realloc(block, size);
}
}
// NOLINTEND(bugprone-reserved-identifier)
#endif

namespace pliant {

bool heap_calls_are_counted() noexcept {
  return PLIANT_COUNTS_HEAP == 1;
}
std::int64_t heap_calls_of_this_thread() noexcept {
  return calls;
}

}  // namespace pliant
