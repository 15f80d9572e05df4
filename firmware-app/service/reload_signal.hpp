// SIGHUP asks a running program to read its configuration again.
#pragma once

#include <csignal>

namespace pliant {

/// While one lives, SIGHUP only sets a flag.
class ReloadSignal {
 public:
  ReloadSignal();
  ReloadSignal(const ReloadSignal&) = delete;
  ReloadSignal& operator=(const ReloadSignal&) = delete;
  ~ReloadSignal();
  /// Whether one came since the last call.
  [[nodiscard]] static bool take() noexcept;

 private:
  struct sigaction before_ {};
};

}  // namespace pliant
