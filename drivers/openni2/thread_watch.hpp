// The threads of this process that a library starts without a word of them.
#pragma once

#include <span>
#include <vector>

namespace pliant {

/// The numbers by which the kernel knows this process's threads; none where it does not tell (no /proc).
[[nodiscard]] std::vector<int> threads_now();

/// Whether each of them has waited for something since it began, or is no more. One that has not yet had a
/// processor has not.
[[nodiscard]] bool have_all_waited(std::span<const int> threads);

}  // namespace pliant
