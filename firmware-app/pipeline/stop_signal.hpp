// SIGINT, SIGTERM and SIGHUP end a run well.
#pragma once

#include <csignal>

namespace pliant {

/// While one lives, SIGINT and SIGTERM only set requested(); a second one ends the program at once. SIGHUP,
/// that of a terminal which closes, sets it too, however often it comes. Where it was ignored (nohup) it
/// stays so; a ReloadSignal made later takes it for itself.
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
  struct sigaction before_hup_ {};
};

}  // namespace pliant
