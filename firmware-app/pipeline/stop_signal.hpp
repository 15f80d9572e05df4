// SIGINT and SIGTERM end a run well.
#pragma once

#include <csignal>

namespace pliant {

/// While one lives, SIGINT and SIGTERM only set requested(). A second one ends the program at once.
class StopSignal {
 public:
  StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal();
  [[nodiscard]] static bool requested() noexcept;

 private:
  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
};

}  // namespace pliant
