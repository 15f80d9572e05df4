#include "firmware-app/pipeline/worker.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <utility>

namespace pliant {

namespace {

constexpr std::size_t kStackBytes = std::size_t{4} << 20;

void* run(void* work) {
  (*static_cast<std::function<void()>*>(work))();
  return nullptr;
}

/// Binds `thread` to those of the processors `wanted` that there are; empty, or what is wrong with them.
std::string bind_to(pthread_t thread, const std::vector<int>& wanted) {
  cpu_set_t processors, given;
  CPU_ZERO(&processors);
  CPU_ZERO(&given);
  for (const int cpu : wanted)
    if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &processors);
  const int error = pthread_setaffinity_np(thread, sizeof processors, &processors);
  if (error != 0 && error != EINVAL) return std::strerror(error);
  // What is not there the system leaves out without a word; it refuses when nothing is left.
  if (error == 0 && pthread_getaffinity_np(thread, sizeof given, &given) != 0) return "";
  std::vector<int> missing;
  for (const int cpu : wanted)
    if (cpu < 0 || cpu >= CPU_SETSIZE || !CPU_ISSET(static_cast<std::size_t>(cpu), &given))
      missing.push_back(cpu);
  if (missing.empty()) return "";
  return fmt::format("{} not there, or not allowed; it runs on {}", fmt::join(missing, ", "),
                     error == 0 ? "the others" : "any");
}

}  // namespace

Outcome Worker::start(const WorkerSettings& settings, std::function<void()> work, std::string& warning) {
  work_ = std::move(work);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  // Signals go to the main thread, which ends the run.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const int failed = pthread_create(&thread_, &attributes, &run, &work_);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_attr_destroy(&attributes);
  if (failed != 0)
    return Error{ErrorKind::device,
                 fmt::format("cannot start a thread for {}: {}", settings.name, std::strerror(failed))};
  running_ = true;
  pthread_setname_np(thread_, settings.name);

  if (settings.priority > 0) {
    const sched_param parameter{settings.priority};
    if (const int error = pthread_setschedparam(thread_, SCHED_FIFO, &parameter); error != 0)
      warning = fmt::format("no real-time priority {} for {} ({}); run as root or raise the rtprio limit",
                            settings.priority, settings.name, std::strerror(error));
  }
  if (!settings.affinity.empty())
    if (const std::string fault = bind_to(thread_, settings.affinity); !fault.empty())
      warning += fmt::format("{}cannot bind {} to the processors asked for: {}", warning.empty() ? "" : "; ",
                             settings.name, fault);
  return success();
}

bool Worker::join_within(int timeout_ms) {
  if (!running_) return true;
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  const std::int64_t nanoseconds = until.tv_nsec + std::int64_t{timeout_ms} * 1'000'000;
  until.tv_sec += static_cast<time_t>(nanoseconds / 1'000'000'000);
  until.tv_nsec = static_cast<long>(nanoseconds % 1'000'000'000);
  if (pthread_timedjoin_np(thread_, nullptr, &until) == 0) {
    running_ = false;
    return true;
  }
  pthread_detach(thread_);
  running_ = false;
  return false;
}

void Worker::join() {
  if (running_) pthread_join(thread_, nullptr);
  running_ = false;
}

}  // namespace pliant
