// The hand-over between threads: in order, newest wins, nothing torn.
#include "drivers/lcm/message_ring.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace pliant {
namespace {

/// A group of two messages that are filled with one number.
bool push_number(MessageRing& ring, std::int64_t number) {
  const std::vector<std::uint8_t> bytes(64, static_cast<std::uint8_t>(number));
  const std::vector<MessageBody> bodies = {{MessageKind::pose, std::span(bytes).first(40)},
                                           {MessageKind::regions, std::span(bytes).first(24)}};
  return ring.push(bodies, number);
}

TEST(MessageRing, GivesGroupsInOrderAndWhole) {
  MessageRing ring(4, 2, 64);
  MessageRing::Group group;
  EXPECT_FALSE(ring.take(group));
  for (std::int64_t number = 1; number <= 3; ++number) ASSERT_TRUE(push_number(ring, number));
  for (std::int64_t number = 1; number <= 3; ++number) {
    ASSERT_TRUE(ring.take(group));
    EXPECT_EQ(group.utime, number);
    ASSERT_EQ(group.bodies.size(), 2U);
    EXPECT_EQ(group.bodies[0].kind, MessageKind::pose);
    EXPECT_EQ(group.bodies[0].bytes.size(), 40U);
    EXPECT_EQ(group.bodies[1].bytes.size(), 24U);
    EXPECT_EQ(group.bodies[1].bytes[23], number);
    ring.release();
  }
  EXPECT_FALSE(ring.take(group));
  EXPECT_EQ(ring.gave_way(), 0);
}

TEST(MessageRing, WhenFullTheOldestGivesWay) {
  MessageRing ring(4, 2, 64);
  for (std::int64_t number = 1; number <= 10; ++number) ASSERT_TRUE(push_number(ring, number));
  EXPECT_EQ(ring.gave_way(), 6);
  MessageRing::Group group;
  for (std::int64_t number = 7; number <= 10; ++number) {
    ASSERT_TRUE(ring.take(group));
    EXPECT_EQ(group.utime, number);
    ring.release();
  }
  EXPECT_FALSE(ring.take(group));
}

TEST(MessageRing, WhatIsBeingSentIsNotOverwritten) {
  MessageRing ring(3, 2, 64);
  MessageRing::Group group;
  ASSERT_TRUE(push_number(ring, 1));
  ASSERT_TRUE(ring.take(group));
  for (std::int64_t number = 2; number <= 50; ++number) ASSERT_TRUE(push_number(ring, number));
  EXPECT_EQ(group.utime, 1);
  EXPECT_EQ(group.bodies[0].bytes[0], 1);
  ring.release();
  ASSERT_TRUE(ring.take(group));
  EXPECT_EQ(group.utime, 49);
  ring.release();
}

TEST(MessageRing, RefusesWhatIsLargerThanASlot) {
  MessageRing ring(3, 2, 63);
  EXPECT_FALSE(push_number(ring, 1));
  MessageRing::Group group;
  EXPECT_FALSE(ring.take(group));
  MessageRing narrow(3, 1, 64);
  EXPECT_FALSE(push_number(narrow, 1));
}

class MessageRingSlots : public ::testing::TestWithParam<std::size_t> {};

TEST_P(MessageRingSlots, TwoThreadsSeeWholeGroupsInAscendingOrder) {
  const std::size_t slots = GetParam();
  constexpr std::int64_t kGroups = 100000;
  MessageRing ring(slots, 2, 64);
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (std::int64_t number = 1; number <= kGroups; ++number) {
      if (!push_number(ring, number)) break;
    }
    done.store(true);
  });
  std::int64_t last = 0, taken = 0, torn = 0, disordered = 0;
  MessageRing::Group group;
  for (bool over = false; !over;) {
    over = done.load();
    while (ring.take(group)) {
      const auto expected = static_cast<std::uint8_t>(group.utime);
      for (const MessageBody& body : group.bodies) {
        for (const std::uint8_t byte : body.bytes) torn += byte != expected ? 1 : 0;
      }
      disordered += group.utime <= last ? 1 : 0;
      last = group.utime;
      ++taken;
      ring.release();
    }
  }
  producer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(disordered, 0);
  EXPECT_EQ(last, kGroups) << "the newest is never given up";
  EXPECT_EQ(taken + ring.gave_way(), kGroups);
}

INSTANTIATE_TEST_SUITE_P(Few, MessageRingSlots, ::testing::Values(3, 4, 7));

}  // namespace
}  // namespace pliant
