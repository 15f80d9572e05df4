#include "firmware-app/pipeline/worker.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <atomic>
#include <memory>

#include "firmware-app/measure/clock.hpp"
#include "firmware-app/pipeline/memory_block.hpp"
#include "firmware-app/pipeline/touch_program.hpp"

namespace pliant {
namespace {

/// What the system says of the thread that asks.
struct Placement {
  int policy = -1, priority = -1, processors = 0;
  bool on_first = false;
};

Placement placement() {
  Placement p;
  sched_param parameter{};
  pthread_getschedparam(pthread_self(), &p.policy, &parameter);
  p.priority = parameter.sched_priority;
  cpu_set_t set;
  CPU_ZERO(&set);
  pthread_getaffinity_np(pthread_self(), sizeof set, &set);
  p.processors = CPU_COUNT(&set);
  p.on_first = CPU_ISSET(0, &set);
  return p;
}

/// Runs placement() on a worker, after its settings were made.
Placement placement_on(const WorkerSettings& settings, std::string& warning) {
  Placement p;
  std::atomic<bool> go{false};
  Worker worker;
  const Outcome started = worker.start(
      settings,
      [&] {
        while (!go.load()) usleep(1000);
        p = placement();
      },
      warning);
  EXPECT_TRUE(started);
  go.store(true);
  worker.join();
  return p;
}

TEST(Worker, RunsWherePriorityAndAffinitySay) {
  std::string warning;
  const Placement p = placement_on({.name = "test", .priority = 10, .affinity = {0}}, warning);
  EXPECT_EQ(p.processors, 1);
  EXPECT_TRUE(p.on_first);
  if (warning.empty()) {
    EXPECT_EQ(p.policy, SCHED_FIFO);
    EXPECT_EQ(p.priority, 10);
  } else {  // not permitted here: it runs all the same and says why not
    EXPECT_EQ(p.policy, SCHED_OTHER);
    EXPECT_NE(warning.find("rtprio"), std::string::npos) << warning;
  }
}

TEST(Worker, TellsOfProcessorsThatAreNotThere) {
  std::string warning;
  const Placement p = placement_on({.name = "test", .priority = 0, .affinity = {1023}}, warning);
  EXPECT_NE(warning.find("cannot bind test"), std::string::npos) << warning;
  EXPECT_GE(p.processors, 1);
}

TEST(Worker, NamesTheProcessorsThatAreNotThereBesideThoseThatAre) {
  std::string warning;
  const Placement p = placement_on({.name = "test", .priority = 0, .affinity = {0, 1022, 1023}}, warning);
  EXPECT_NE(warning.find("1022, 1023 not there"), std::string::npos) << warning;
  EXPECT_EQ(p.processors, 1);
  EXPECT_TRUE(p.on_first);
}

TEST(Worker, WorkThatHangsDoesNotHoldTheOthersUp) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  auto ended = std::make_shared<std::atomic<bool>>(false);
  auto* worker = new Worker;  // stays while its work goes on
  std::string warning;
  ASSERT_TRUE(worker->start(
      {.name = "test", .priority = 0, .affinity = {}},
      [release, ended] {
        while (!release->load()) usleep(1000);
        ended->store(true);
      },
      warning));
  const std::int64_t before = monotonic_ns();
  EXPECT_FALSE(worker->join_within(100));
  EXPECT_LT(monotonic_ns() - before, 5'000'000'000);
  release->store(true);
  for (int i = 0; i < 5000 && !ended->load(); ++i) usleep(1000);
  EXPECT_TRUE(ended->load());
  usleep(100'000);
  delete worker;
}

TEST(Memory, IsLockedOrItIsSaidWhyNot) {
  const std::string warning = lock_memory();
  if (!warning.empty()) {
    EXPECT_NE(warning.find("memlock"), std::string::npos) << warning;
  }
}

TEST(Memory, AllOfTheProgramIsTouched) {
  EXPECT_GT(touch_program(), std::size_t{1} << 20);
}

}  // namespace
}  // namespace pliant
