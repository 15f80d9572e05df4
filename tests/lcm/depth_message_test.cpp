// Depth pictures as messages: the generated class's bytes, every part usable, bad input refused.
#include "drivers/lcm/depth_messages.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "drivers/lcm/messages.hpp"
#include "drivers/lcm/publisher.hpp"
#include "drivers/lcm/subscriber.hpp"
#include "pliant/depth_t.hpp"

namespace pliant {
namespace {

/// A picture whose rows are longer in memory than they are wide.
struct Picture {
  std::vector<std::uint16_t> pixels;
  DepthFrame frame;
  Intrinsics camera;

  Picture(int width, int height) {
    const int stride = width + 3;
    for (int i = 0; i < stride * height; ++i) pixels.push_back(static_cast<std::uint16_t>(7 * i + 40000));
    frame = {pixels.data(), width, height, stride, 1'700'000'000'000'000, 12};
    camera = {width, height, 570.0, 571.0, 0.5 * width, 0.5 * height, 1000};
  }
};

TEST(LcmDepth, PartsAreWhatTheGeneratedClassWritesAndMakeUpThePicture) {
  const Picture picture(640, 480);
  DepthMessages messages(640, 480);
  const auto bodies = messages.encode(picture.frame, picture.camera);
  ASSERT_EQ(bodies.size(), 11U);
  std::vector<std::uint16_t> put_together;
  for (std::size_t part = 0; part < bodies.size(); ++part) {
    EXPECT_EQ(bodies[part].kind, MessageKind::depth);
    EXPECT_LE(bodies[part].bytes.size(), kMaxDepthMessageBytes);
    DepthMessage message;
    ASSERT_TRUE(decode(bodies[part].bytes, message));
    EXPECT_EQ(message.first_row * 640, std::ssize(put_together));
    put_together.insert(put_together.end(), message.depth.begin(), message.depth.end());

    depth_t generated;
    generated.utime = picture.frame.utime;
    generated.frame = 12;
    generated.part = static_cast<std::int16_t>(part);
    generated.parts = 11;
    generated.width = 640;
    generated.height = 480;
    generated.fx = 570;
    generated.fy = 571;
    generated.cx = 320;
    generated.cy = 240;
    generated.depth_scale = 1000;
    generated.first_row = message.first_row;
    generated.num_rows = static_cast<std::int32_t>(message.depth.size() / 640);
    for (const std::uint16_t reading : message.depth) {
      generated.depth.push_back(static_cast<std::uint8_t>(reading & 0xFFU));
      generated.depth.push_back(static_cast<std::uint8_t>(reading >> 8));
    }
    generated.num_bytes = static_cast<std::int32_t>(generated.depth.size());
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(generated.getEncodedSize()));
    generated.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    EXPECT_EQ(std::vector<std::uint8_t>(bodies[part].bytes.begin(), bodies[part].bytes.end()), bytes);
  }
  ASSERT_EQ(put_together.size(), 640U * 480U);
  for (std::size_t v = 0; v < 480; ++v) {
    for (std::size_t u = 0; u < 640; ++u) ASSERT_EQ(put_together[v * 640 + u], picture.pixels[v * 643 + u]);
  }
}

TEST(LcmDepth, RefusesCutsAndImpossibleSizes) {
  const Picture picture(32, 24);
  DepthMessages messages(32, 24);
  const auto bodies = messages.encode(picture.frame, picture.camera);
  ASSERT_EQ(bodies.size(), 1U);
  const std::vector<std::uint8_t> body(bodies[0].bytes.begin(), bodies[0].bytes.end());
  DepthMessage message;
  for (std::size_t length = 0; length < body.size(); ++length) {
    const std::vector<std::uint8_t> cut(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(length));
    ASSERT_FALSE(decode(cut, message));
  }
  // Width, height, first row, rows and bytes: one more or a huge number fits nothing.
  for (const std::size_t offset : {28U, 32U, 76U, 80U, 84U}) {
    for (const std::size_t byte : {offset, offset + 3}) {
      auto damaged = body;
      damaged[byte] = static_cast<std::uint8_t>(damaged[byte] + 1);
      const bool taller = offset == 32 && byte == offset + 3;  // a picture of which this is the upper part
      EXPECT_EQ(decode(damaged, message), taller) << byte;
    }
  }
}

TEST(LcmDepth, PicturesOfAnotherSizeAreNotSent) {
  const Picture picture(64, 48);
  DepthMessages messages(63, 48);
  EXPECT_TRUE(messages.encode(picture.frame, picture.camera).empty());
  EXPECT_TRUE(messages.encode({}, picture.camera).empty());
}

TEST(LcmDepth, IsPublishedToWhoAsksForIt) {
  auto bus = LcmBus::open("memq://");
  ASSERT_TRUE(bus);
  const Picture picture(320, 240);
  std::size_t readings = 0;
  LcmSubscriber::Handlers handlers;
  handlers.depth = [&](const DepthMessage& message) { readings += message.depth.size(); };
  auto subscriber = LcmSubscriber::create(*bus, "PLIANT", handlers);
  ASSERT_TRUE(subscriber);
  LcmSettings settings;
  auto without = LcmPublisher::create(*bus, settings, 10);
  ASSERT_TRUE(without);
  (*without)->publish_depth(picture.frame, picture.camera);
  EXPECT_EQ((*without)->counters().failures, 1);

  settings.depth_width = 320;
  settings.depth_height = 240;
  auto publisher = LcmPublisher::create(*bus, settings, 10);
  ASSERT_TRUE(publisher);
  (*publisher)->publish_depth(picture.frame, picture.camera);
  ASSERT_TRUE((*publisher)->flush(10000));
  (*subscriber)->handle(1000);
  EXPECT_EQ(readings, 320U * 240U);
  EXPECT_EQ((*subscriber)->counters().garbage, 0);
  EXPECT_EQ((*publisher)->counters().failures, 0);
}

}  // namespace
}  // namespace pliant
