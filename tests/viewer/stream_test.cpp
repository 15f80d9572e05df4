// The newest wins, and nobody waits for anybody.
#include "firmware-app/viewer/stream.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace pliant::viewer {
namespace {

using std::chrono::milliseconds;

TEST(ViewerStream, EachTakerGetsTheNewestOfEachKindOnce) {
  Stream stream;
  for (std::uint8_t i = 0; i < 50; ++i) stream.publish(PacketKind::frame, {i});
  stream.publish(PacketKind::model, {200});
  stream.publish(PacketKind::depth, {201});
  Stream::Seen one{}, two{};
  auto packets = stream.take_newer(one, milliseconds(0), true);
  ASSERT_EQ(packets.size(), 3U);
  EXPECT_EQ(packets[0]->front(), 200) << "the model comes before the frame that needs it";
  EXPECT_EQ(packets[1]->front(), 49);
  EXPECT_EQ(packets[2]->front(), 201);
  EXPECT_TRUE(stream.take_newer(one, milliseconds(0), true).empty());
  EXPECT_EQ(stream.take_newer(two, milliseconds(0), false).size(), 2U) << "without depth";
  stream.publish(PacketKind::frame, {7});
  EXPECT_EQ(stream.take_newer(one, milliseconds(0), true).size(), 1U);
}

TEST(ViewerStream, WhatNobodyTakesIsFreed) {
  Stream stream;
  Stream::Seen seen{};
  stream.publish(PacketKind::frame, {1});
  std::weak_ptr<const std::vector<std::uint8_t>> old = stream.take_newer(seen, milliseconds(0), true).front();
  EXPECT_FALSE(old.expired());
  stream.publish(PacketKind::frame, {2});
  EXPECT_TRUE(old.expired());
}

TEST(ViewerStream, WhoWaitsIsWokenByNewsAndByTheEnd) {
  Stream stream;
  std::size_t got = 0;
  std::thread waiting([&] {
    Stream::Seen seen{};
    got = stream.take_newer(seen, milliseconds(10000), true).size();
    EXPECT_TRUE(stream.take_newer(seen, milliseconds(10000), true).empty());
  });
  std::this_thread::sleep_for(milliseconds(30));
  stream.publish(PacketKind::status, {1});
  std::this_thread::sleep_for(milliseconds(30));
  const auto begin = std::chrono::steady_clock::now();
  stream.close();
  waiting.join();
  EXPECT_EQ(got, 1U);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(5000));
}

}  // namespace
}  // namespace pliant::viewer
