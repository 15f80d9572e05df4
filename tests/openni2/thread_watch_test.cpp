#include "drivers/openni2/thread_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iterator>
#include <thread>

namespace pliant::test {
namespace {

std::vector<int> since(const std::vector<int>& before) {
  const std::vector<int> now = threads_now();
  std::vector<int> fresh;
  std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(fresh));
  return fresh;
}

TEST(ThreadWatch, KnowsAThreadFromItsStartToItsEnd) {
  const std::vector<int> before = threads_now();
  ASSERT_FALSE(before.empty());
  std::atomic<bool> enough = false;
  std::thread thread([&] {
    while (!enough) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  const std::vector<int> fresh = since(before);
  EXPECT_EQ(fresh.size(), 1U);
  enough = true;
  thread.join();
  EXPECT_TRUE(have_all_waited(fresh));
}

TEST(ThreadWatch, WhoIsStillAtWorkHasNotWaited) {
  const std::vector<int> before = threads_now();
  std::atomic<bool> enough = false, waiting = false;
  std::thread thread([&] {
    while (!enough) continue;
    waiting = true;
    while (waiting) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  const std::vector<int> fresh = since(before);
  ASSERT_EQ(fresh.size(), 1U);
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(have_all_waited(fresh));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  enough = true;
  for (int i = 0; i < 5000 && !have_all_waited(fresh); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(have_all_waited(fresh));
  waiting = false;
  thread.join();
}

}  // namespace
}  // namespace pliant::test
