#include "drivers/openni2/thread_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace pliant {

namespace {

/// How often a thread let the processor go of its own accord; -1 of one that is no more.
long waits_of(int thread) {
  std::ifstream status(fmt::format("/proc/self/task/{}/status", thread));
  std::string word;
  long count = 0;
  while (status >> word)
    if (word == "voluntary_ctxt_switches:" && status >> count) return count;
  return -1;
}

}  // namespace

std::vector<int> threads_now() {
  std::vector<int> threads;
  std::error_code fault;
  for (std::filesystem::directory_iterator entry("/proc/self/task", fault), end; !fault && entry != end;
       entry.increment(fault)) {
    const std::string name = entry->path().filename().string();
    int thread = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), thread).ec == std::errc())
      threads.push_back(thread);
  }
  std::sort(threads.begin(), threads.end());
  return threads;
}

bool have_all_waited(std::span<const int> threads) {
  return std::all_of(threads.begin(), threads.end(), [](int thread) { return waits_of(thread) != 0; });
}

}  // namespace pliant
