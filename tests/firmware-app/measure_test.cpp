#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <thread>

#include "firmware-app/measure/clock.hpp"
#include "firmware-app/measure/frame_rate.hpp"
#include "firmware-app/measure/histogram.hpp"
#include "firmware-app/measure/latency_meter.hpp"
#include "firmware-app/measure/path_cost.hpp"
#include "firmware-app/measure/stage_profile.hpp"

namespace pliant {
namespace {

TEST(Histogram, EmptyIsZero) {
  const Histogram histogram;
  EXPECT_EQ(histogram.median(), 0);
  EXPECT_EQ(histogram.max(), 0);
}

TEST(Histogram, SmallValuesAreExact) {
  Histogram histogram;
  for (int i = 0; i <= 100; ++i) histogram.add(i);
  EXPECT_EQ(histogram.median(), 50);
  EXPECT_EQ(histogram.p99(), 99);
  EXPECT_EQ(histogram.max(), 100);
}

TEST(Histogram, QuantilesAreWithinOnePercentOverAllMagnitudes) {
  for (std::int64_t scale = 1; scale < 1'000'000'000; scale *= 10) {
    Histogram histogram;
    for (int i = 1; i <= 1001; ++i) histogram.add(scale * i);
    EXPECT_NEAR(static_cast<double>(histogram.median()), 501.0 * static_cast<double>(scale),
                5.02 * static_cast<double>(scale));
    EXPECT_NEAR(static_cast<double>(histogram.p99()), 991.0 * static_cast<double>(scale),
                9.92 * static_cast<double>(scale));
    EXPECT_EQ(histogram.max(),
              1001 * scale < (std::int64_t{1} << 40) ? 1001 * scale : (std::int64_t{1} << 40) - 1);
  }
}

TEST(Histogram, ExtremesDoNotEscape) {
  Histogram histogram;
  histogram.add(-5);
  histogram.add(INT64_MAX);
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.quantile(0), 0);
  EXPECT_GT(histogram.quantile(1), std::int64_t{1} << 38);
}

TEST(StageProfile, SumsStagesAndCountsTotalOnlyWhenTracked) {
  StageProfile profile;
  const StageObserver observer = profile.observer();
  profile.begin_frame();
  observer.stage_done(observer.context, Stage::surface);
  observer.stage_done(observer.context, Stage::align);
  observer.stage_done(observer.context, Stage::align);
  profile.end_frame(false);
  EXPECT_EQ(profile.stage(static_cast<int>(Stage::align)).count(), 1U);
  EXPECT_EQ(profile.stage(static_cast<int>(Stage::detect)).count(), 0U);
  EXPECT_EQ(profile.total().count(), 0U);
  EXPECT_EQ(profile.last(static_cast<int>(Stage::deform)), -1);
  profile.begin_frame();
  profile.end_frame(true);
  EXPECT_EQ(profile.total().count(), 1U);
}

TEST(LatencyMeter, KnowsFramesByTheirStamp) {
  LatencyMeter meter;
  meter.arrived(33'000, monotonic_ns() - 5'000'000);
  meter.sent(66'000);  // not one of ours
  EXPECT_EQ(meter.whole().count(), 0U);
  meter.sent(33'000);
  meter.sent(33'000);  // counted once
  EXPECT_EQ(meter.whole().count(), 1U);
  EXPECT_GE(meter.whole().max(), 5'000'000);
  EXPECT_GE(meter.take_recent()[2], 5'000'000);
  EXPECT_EQ(meter.take_recent()[2], 0);
}

TEST(PathWatch, CountsHeapCallsOfItsThreadOnly) {
  if (!heap_is_watched()) GTEST_SKIP() << "a sanitizer brings a heap of its own";
  PathCost cost;
  {
    PathWatch watch(cost);
    std::thread other([] { std::free(std::malloc(100)); });
    other.join();
    watch.update();
    const std::uint64_t before = cost.heap_calls.load();
    // Volatile pointers: the compiler may not leave the pairs out.
    void* volatile block = std::malloc(10);
    std::free(block);
    int* volatile number = new int(3);
    delete number;
    watch.update();
    EXPECT_EQ(cost.heap_calls.load() - before, 4U);
  }
  const std::uint64_t after = cost.heap_calls.load();
  void* volatile block = std::malloc(10);
  std::free(block);
  EXPECT_EQ(cost.heap_calls.load(), after);
}

TEST(PathWatch, CountsPageFaults) {
  PathCost cost;
  const std::size_t bytes = std::size_t{8} << 20;  // large enough to come fresh from the system
  {
    const PathWatch watch(cost);
    const std::unique_ptr<volatile char[]> block(new char[bytes]);
    for (std::size_t i = 0; i < bytes; i += 4096) block[i] = 1;
  }
  EXPECT_GT(cost.page_faults.load(), 0U);
}

TEST(FrameRate, IsNeverToldFromAMoment) {
  constexpr std::int64_t kMs = 1'000'000;
  FrameRate rate(7000 * kMs);
  EXPECT_EQ(rate.update(7002 * kMs, 1), 0) << "one frame in two milliseconds are no 500 a second";
  EXPECT_DOUBLE_EQ(rate.update(8000 * kMs, 30), 30);
  EXPECT_DOUBLE_EQ(rate.update(8001 * kMs, 31), 30) << "a state changed just after a status";
  EXPECT_DOUBLE_EQ(rate.update(9000 * kMs, 45), 15);
  EXPECT_DOUBLE_EQ(rate.update(11000 * kMs, 45), 0);
}

TEST(Memory, ResidentIsKnown) {
  EXPECT_GT(resident_bytes(), std::uint64_t{100'000});
  EXPECT_GE(peak_resident_bytes(), resident_bytes() / 2);
}

}  // namespace
}  // namespace pliant
