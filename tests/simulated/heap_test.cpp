// No heap call in SimulatedSource::next(). A program of its own because it replaces the allocator.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "drivers/simulated/simulated.hpp"

namespace {
std::atomic<long> heap_calls{0};
}

// Not inlined: the compiler would take malloc and delete for a mismatched pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++heap_calls;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

namespace pliant {
namespace {

TEST(SimulatedHeap, DeliveringAFrameAllocatesNothing) {
  for (const char* options :
       {"cushion?frames=70", "figure?frames=70&width=320&height=240", "box?frames=70&noise=none"}) {
    auto source = open_simulated(options);
    ASSERT_TRUE(source) << source.error().message;
    SourceItem item;
    const long before = heap_calls;
    ASSERT_GT(before, 0);
    do {
      (*source)->next(0, item);
    } while (item.event == SourceEvent::frame);
    EXPECT_EQ(heap_calls, before) << options;
  }
}

}  // namespace
}  // namespace pliant
