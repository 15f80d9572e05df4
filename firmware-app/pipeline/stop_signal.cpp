#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant {

namespace {

volatile std::sig_atomic_t stop_requested = 0;

void on_signal(int /*number*/) {
  stop_requested = 1;
}

}  // namespace

StopSignal::StopSignal() {
  stop_requested = 0;
  struct sigaction action {};
  action.sa_handler = &on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, &before_int_);
  sigaction(SIGTERM, &action, &before_term_);
  sigaction(SIGHUP, nullptr, &before_hup_);
  action.sa_flags = 0;  // a shell and the kernel may both send it
  if (before_hup_.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

StopSignal::~StopSignal() {
  sigaction(SIGINT, &before_int_, nullptr);
  sigaction(SIGTERM, &before_term_, nullptr);
  sigaction(SIGHUP, &before_hup_, nullptr);
}

bool StopSignal::requested() noexcept {
  return stop_requested != 0;
}

}  // namespace pliant
