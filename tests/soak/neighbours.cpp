#include "tests/soak/neighbours.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <vector>

#include "drivers/lcm/subscriber.hpp"

namespace pliant::soak {

namespace {

void subscribe_slowly() {
  const auto pause = [](const auto& /*message*/) { usleep(20'000); };
  LcmSubscriber::Handlers handlers;
  handlers.pose = pause;
  handlers.regions = pause;
  handlers.deformed = pause;
  const auto subscriber = LcmSubscriber::create("", "PLIANT", handlers);
  while (subscriber) (*subscriber)->handle(1000);
}

void be_busy() {
  std::vector<unsigned char> from(std::size_t{8} << 20, 1), to(from.size());
  volatile unsigned char taken = 0;
  for (std::size_t i = 0;; i = (i + 4097) % to.size()) {
    std::memcpy(to.data(), from.data(), from.size());
    taken = to[i];
    from[i] = static_cast<unsigned char>(taken + 1);
  }
}

}  // namespace

pid_t start_neighbour(const char* role) {
  const pid_t process = fork();
  if (process != 0) return process;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  execl("/proc/self/exe", "soak", role, nullptr);
  _exit(127);
}

void end_neighbour(pid_t process) {
  if (process <= 0) return;
  kill(process, SIGKILL);
  waitpid(process, nullptr, 0);
}

void play_neighbour(std::string_view role) {
  if (role == kSlowSubscriber) subscribe_slowly();
  if (role == kBusy) be_busy();
}

}  // namespace pliant::soak
