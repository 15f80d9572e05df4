// Processes that make a run's life hard. They end with the one that started them.
#pragma once

#include <sys/types.h>

#include <string_view>

namespace pliant::soak {

/// Runs this program again as a neighbour: by exec, so that no page of memory is shared with it.
[[nodiscard]] pid_t start_neighbour(const char* role);
void end_neighbour(pid_t process);

inline constexpr const char* kSlowSubscriber = "--slow-subscriber";  ///< takes 20 ms for each message
inline constexpr const char* kBusy = "--busy";  ///< computes and moves memory without end
/// What main() does for such a role; returns when it is none.
void play_neighbour(std::string_view role);

}  // namespace pliant::soak
