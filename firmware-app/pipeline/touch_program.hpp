// The program's own code and data, in memory before the first frame.
#pragma once

#include <cstddef>

namespace pliant {

/// Touches every page of the program and of its libraries, so that code that runs for the first time in the
/// middle of a run, such as the search for a lost object, faults no page. Returns the bytes touched.
std::size_t touch_program() noexcept;

}  // namespace pliant
