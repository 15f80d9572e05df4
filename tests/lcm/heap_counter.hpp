// Counts the heap calls of the calling thread, in C and C++ and all libraries.
#pragma once

#include <cstdint>

namespace pliant {

/// False where the build replaces malloc itself (sanitizers).
[[nodiscard]] bool heap_calls_are_counted() noexcept;
[[nodiscard]] std::int64_t heap_calls_of_this_thread() noexcept;

}  // namespace pliant
