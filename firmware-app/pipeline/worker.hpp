// A thread of the pipeline.
#pragma once

#include <pthread.h>

#include <functional>
#include <string>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

struct WorkerSettings {
  const char* name = "";      ///< as the system's tools show it, at most 15 characters
  int priority = 0;           ///< SCHED_FIFO [1, 99], 0 for the ordinary scheduler
  std::vector<int> affinity;  ///< processors, empty for all
};

/// Runs `work` on a thread of its own, joined by the destructor. The stack is 4 MB.
class Worker {
 public:
  Worker() = default;
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() { join(); }

  /// `work` must not throw. ErrorKind::device when there is no thread to be had. Where only priority or
  /// affinity cannot be had, the thread runs without and `warning` says so.
  [[nodiscard]] Outcome start(const WorkerSettings& settings, std::function<void()> work,
                              std::string& warning);
  void join();
  /// False when the work is not at its end after `timeout_ms`; it then goes on by itself, and what it uses,
  /// this object included, must stay for good.
  [[nodiscard]] bool join_within(int timeout_ms);

 private:
  std::function<void()> work_;
  pthread_t thread_{};
  bool running_ = false;
};

}  // namespace pliant
