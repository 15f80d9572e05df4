#include "firmware-app/pipeline/frame_ring.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace pliant {
namespace {

constexpr Intrinsics kCamera{32, 24, 30, 30, 16, 12, 1000};

struct Ring {
  explicit Ring(FrameRing::Policy policy)
      : memory(std::move(*FrameRing::allocate(kCamera))), ring(kCamera, policy, memory), pixels(40 * 24) {}
  void push(std::int64_t number) {
    std::fill(pixels.begin(), pixels.end(), static_cast<std::uint16_t>(number));
    EXPECT_TRUE(ring.push({pixels.data(), 32, 24, 40, number * 1000, number}, number));
  }
  MemoryBlock memory;
  FrameRing ring;
  std::vector<std::uint16_t> pixels;  // rows of 40: a stride wider than the frame
};

TEST(FrameRing, KeepsEveryFrameInOrder) {
  Ring r(FrameRing::Policy::keep_all);
  std::thread producer([&] {
    for (int i = 0; i < 500; ++i) r.push(i);
    r.ring.close();
  });
  std::int64_t expected = 0;
  while (const CapturedFrame* captured = r.ring.pop()) {
    ASSERT_EQ(captured->frame.number, expected);
    ASSERT_EQ(captured->frame.stride, 32);
    ASSERT_EQ(captured->frame.depth[0], expected);
    ASSERT_EQ(captured->frame.depth[32 * 24 - 1], expected);
    ++expected;
  }
  producer.join();
  EXPECT_EQ(expected, 500);
  EXPECT_EQ(r.ring.dropped(), 0U);
}

TEST(FrameRing, NewestWinsAndDropsAreCounted) {
  Ring r(FrameRing::Policy::newest);
  for (int i = 0; i < 10; ++i) r.push(i);
  const CapturedFrame* captured = r.ring.pop();
  ASSERT_NE(captured, nullptr);
  EXPECT_EQ(captured->frame.number, 9);
  EXPECT_EQ(r.ring.dropped(), 9U);
  // The frame being read is not overwritten, however many come.
  for (int i = 10; i < 20; ++i) r.push(i);
  EXPECT_EQ(captured->frame.depth[5], 9);
  r.ring.close();
  captured = r.ring.pop();
  ASSERT_NE(captured, nullptr);
  EXPECT_EQ(captured->frame.number, 19);
  EXPECT_EQ(r.ring.pop(), nullptr);
  EXPECT_EQ(r.ring.dropped(), 18U);
}

TEST(FrameRing, CloseWakesAWaitingProducer) {
  Ring r(FrameRing::Policy::keep_all);
  std::thread producer([&] {
    while (r.ring.push({r.pixels.data(), 32, 24, 40, 0, 0}, 0)) {
    }
  });
  r.ring.abort();
  producer.join();
  while (r.ring.pop() != nullptr) {
  }
}

}  // namespace
}  // namespace pliant
