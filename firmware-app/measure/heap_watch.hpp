// The thread-local counter between heap_watch.cpp, which stands in for the heap, and PathWatch.
#pragma once

#include <cstdint>

namespace pliant::heap_watch {

/// Plain data without a constructor: reading it inside malloc() needs no set-up. Defined beside malloc() in
/// heap_watch.cpp, so that a program that uses it gets the counting heap with it.
struct Counter {
  bool on;
  std::uint64_t calls;
};
extern thread_local constinit Counter counter;
extern const bool kWatched;

}  // namespace pliant::heap_watch
