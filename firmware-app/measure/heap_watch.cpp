// Stands in front of the C library's heap and counts the calls of watched threads. operator new and delete
// end in malloc() and free(), so they count as well.
#include "firmware-app/measure/heap_watch.hpp"

#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PLIANT_HEAP_WATCHED 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PLIANT_HEAP_WATCHED 0
#endif
#endif
#ifndef PLIANT_HEAP_WATCHED
#define PLIANT_HEAP_WATCHED 1
#endif

namespace pliant::heap_watch {

thread_local constinit Counter counter{false, 0};
const bool kWatched = PLIANT_HEAP_WATCHED == 1;

}  // namespace pliant::heap_watch

#if PLIANT_HEAP_WATCHED

namespace {

void count() noexcept {
  pliant::heap_watch::Counter& counter = pliant::heap_watch::counter;
  if (counter.on) ++counter.calls;
}

bool is_power_of_two(std::size_t n) noexcept {
  return n != 0 && (n & (n - 1)) == 0;
}

}  // namespace

// The GNU C library's own names for its heap, kept by it for programs that stand in front of malloc().
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* block, std::size_t size) {
  count();
  return __libc_realloc(block, size);
}
void free(void* block) {
  count();
  __libc_free(block);
}
void* memalign(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  count();
  if (!is_power_of_two(alignment) || alignment % sizeof(void*) != 0) return EINVAL;
  void* got = __libc_memalign(alignment, size);
  if (got == nullptr) return ENOMEM;
  *block = got;
  return 0;
}
}
// NOLINTEND(bugprone-reserved-identifier)

#endif
