#include "firmware-app/service/reload_signal.hpp"

namespace pliant {

namespace {

volatile std::sig_atomic_t reload_requested = 0;

void on_signal(int /*number*/) {
  reload_requested = 1;
}

}  // namespace

ReloadSignal::ReloadSignal() {
  reload_requested = 0;
  struct sigaction action {};
  action.sa_handler = &on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGHUP, &action, &before_);
}

ReloadSignal::~ReloadSignal() {
  sigaction(SIGHUP, &before_, nullptr);
}

bool ReloadSignal::take() noexcept {
  if (reload_requested == 0) return false;
  reload_requested = 0;
  return true;
}

}  // namespace pliant
