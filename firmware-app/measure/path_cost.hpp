// What the path of a frame costs the system: heap calls and page faults, counted by the program itself.
#pragma once

#include <atomic>
#include <cstdint>

namespace pliant {

/// Sums over the threads on the path of a frame.
struct PathCost {
  std::atomic<std::uint64_t> heap_calls{0};   ///< malloc, free and all that end there
  std::atomic<std::uint64_t> page_faults{0};  ///< minor and major
};

/// While one lives, the calling thread's heap calls and page faults count. update() adds what came since the
/// last call to the sums; the destructor does so too. It makes no heap call itself.
class PathWatch {
 public:
  explicit PathWatch(PathCost& cost) noexcept;
  PathWatch(const PathWatch&) = delete;
  PathWatch& operator=(const PathWatch&) = delete;
  ~PathWatch();
  void update() noexcept;

 private:
  PathCost& cost_;
  std::uint64_t heap_calls_ = 0;   // of this thread at the last update
  std::uint64_t page_faults_ = 0;  // likewise
};

/// Heap calls of this thread so far, while it was watched.
[[nodiscard]] std::uint64_t thread_heap_calls() noexcept;
/// False where the heap cannot be watched: in builds with a sanitizer, which brings a heap of its own.
[[nodiscard]] bool heap_is_watched() noexcept;

/// Writes to the 256 kB of stack below the caller, so that later calls find them mapped.
void touch_stack() noexcept;

/// Resident memory of the process, now and at its highest, bytes; 0 where the system does not tell.
[[nodiscard]] std::uint64_t resident_bytes() noexcept;
[[nodiscard]] std::uint64_t peak_resident_bytes() noexcept;

}  // namespace pliant
