#include "firmware-app/measure/path_cost.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "firmware-app/measure/heap_watch.hpp"

namespace pliant {

namespace {

std::uint64_t thread_page_faults() noexcept {
  rusage usage{};
  if (getrusage(RUSAGE_THREAD, &usage) != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_minflt) + static_cast<std::uint64_t>(usage.ru_majflt);
}

}  // namespace

PathWatch::PathWatch(PathCost& cost) noexcept
    : cost_(cost), heap_calls_(heap_watch::counter.calls), page_faults_(thread_page_faults()) {
  heap_watch::counter.on = true;
}

PathWatch::~PathWatch() {
  update();
  heap_watch::counter.on = false;
}

void PathWatch::update() noexcept {
  const std::uint64_t heap_calls = heap_watch::counter.calls, page_faults = thread_page_faults();
  cost_.heap_calls.fetch_add(heap_calls - heap_calls_, std::memory_order_relaxed);
  cost_.page_faults.fetch_add(page_faults - page_faults_, std::memory_order_relaxed);
  heap_calls_ = heap_calls;
  page_faults_ = page_faults;
}

std::uint64_t thread_heap_calls() noexcept {
  return heap_watch::counter.calls;
}

bool heap_is_watched() noexcept {
  return heap_watch::kWatched;
}

void touch_stack() noexcept {
  constexpr std::size_t kBytes = std::size_t{256} << 10, kPage = 4096;
  volatile unsigned char stack[kBytes];
  for (std::size_t i = 0; i < kBytes; i += kPage) {
    stack[i] = 0;
    static_cast<void>(stack[i]);  // volatile: the page is written and read
  }
}

namespace {

/// A line "VmRSS:  1234 kB" of the system's page about this process, in bytes. Reads into a buffer of its
/// own: this is asked for while frames flow.
std::uint64_t status_bytes(const char* name) noexcept {
  const int file = open("/proc/self/status", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  char text[4096];
  const ssize_t got = read(file, text, sizeof text - 1);
  close(file);
  if (got <= 0) return 0;
  text[got] = '\0';
  const char* line = std::strstr(text, name);
  return line == nullptr ? 0 : std::strtoull(line + std::strlen(name), nullptr, 10) * 1024;
}

}  // namespace

std::uint64_t resident_bytes() noexcept {
  return status_bytes("\nVmRSS:");
}

std::uint64_t peak_resident_bytes() noexcept {
  return status_bytes("\nVmHWM:");
}

}  // namespace pliant
