// Frames, put together from what a network delivers: whole, late, twice or not at all.
#include "drivers/lcm/frame_assembler.hpp"

#include <gtest/gtest.h>

#include "drivers/lcm/depth_messages.hpp"
#include "drivers/lcm/track_messages.hpp"
#include "tests/lcm/sample_result.hpp"

namespace pliant {
namespace {

/// Hands bodies to an assembler; how many frames they made.
int feed(FrameAssembler& assembler, std::span<const MessageBody> bodies) {
  int frames = 0;
  for (const MessageBody& body : bodies) {
    RegionsMessage regions;
    DeformedMessage deformed;
    if (body.kind == MessageKind::regions && decode(body.bytes, regions))
      frames += assembler.take(regions) ? 1 : 0;
    if (body.kind == MessageKind::deformed && decode(body.bytes, deformed))
      frames += assembler.take(deformed) ? 1 : 0;
  }
  return frames;
}

ReceivedModel model_of(const SampleResult& sample) {
  return {static_cast<std::int64_t>(kSampleModelId), 0.01F, sample.rest,
          std::vector<Point3f>(sample.rest.size())};
}

TEST(FrameAssembler, AFrameOfManyPartsIsWholeAtItsLast) {
  SampleResult sample(16000, 3);
  TrackMessages messages(sample.rest, kSampleModelId);
  FrameAssembler assembler;
  EXPECT_EQ(feed(assembler, messages.encode(sample.result)), 1);
  const ReceivedFrame& frame = assembler.frame();
  EXPECT_EQ(frame.frame, sample.result.frame);
  EXPECT_EQ(frame.state, TrackState::tracking);
  EXPECT_EQ(frame.regions.size(), 3U);
  EXPECT_EQ(frame.labels, sample.labels);
  std::size_t deformed = 0;
  for (std::size_t i = 0; i < sample.labels.size(); ++i) {
    if (sample.labels[i] != kDeformed) continue;
    ASSERT_EQ(static_cast<std::size_t>(frame.deformed[deformed]), i);
    ASSERT_FLOAT_EQ(frame.position[deformed].z, sample.positions[i].z);
    ASSERT_EQ(frame.strain[deformed], sample.strains[i]);
    ++deformed;
  }
  EXPECT_EQ(frame.deformed.size(), deformed);
  EXPECT_EQ(frame.strain.size(), deformed);
  EXPECT_EQ(feed(assembler, messages.encode(sample.result)), 0) << "the same frame again is no new one";
}

TEST(FrameAssembler, AFrameWithAPartMissingIsGivenUpForTheNext) {
  SampleResult sample(16000, 3);
  TrackMessages messages(sample.rest, kSampleModelId);
  FrameAssembler assembler;
  auto bodies = messages.encode(sample.result);
  EXPECT_EQ(feed(assembler, bodies.first(bodies.size() - 1)), 0);
  sample.result.frame = 4712;
  EXPECT_EQ(feed(assembler, messages.encode(sample.result)), 1);
  EXPECT_EQ(assembler.frame().frame, 4712);
  EXPECT_EQ(assembler.incomplete(), 1);
  sample.result.frame = 4713;
  sample.lose(TrackState::lost);
  EXPECT_EQ(feed(assembler, messages.encode(sample.result)), 1) << "a lost frame has no deformed message";
  EXPECT_EQ(assembler.frame().state, TrackState::lost);
  EXPECT_TRUE(assembler.frame().labels.empty());
  EXPECT_TRUE(assembler.frame().deformed.empty());
  EXPECT_TRUE(assembler.frame().strain.empty());
}

TEST(FrameAssembler, PartsMayComeInAnyOrderAndTwice) {
  SampleResult sample(16000, 3);
  TrackMessages messages(sample.rest, kSampleModelId);
  FrameAssembler straight, turned;
  const auto bodies = messages.encode(sample.result);
  ASSERT_GT(bodies.size(), 3U);
  std::vector<MessageBody> backwards{bodies[1]};
  for (std::size_t i = bodies.size(); i-- > 0;) backwards.push_back(bodies[i]);
  EXPECT_EQ(feed(straight, bodies), 1);
  EXPECT_EQ(feed(turned, backwards), 1);
  EXPECT_EQ(turned.frame().labels, straight.frame().labels);
  EXPECT_EQ(turned.frame().deformed, straight.frame().deformed);
  EXPECT_EQ(turned.frame().strain, straight.frame().strain);
  EXPECT_EQ(turned.frame().position.size(), straight.frame().position.size());
  EXPECT_EQ(turned.incomplete(), 0);
}

TEST(FrameAssembler, AFrameThatTellsAPointTwiceIsGivenUp) {
  RegionsMessage regions;
  regions.state = TrackState::tracking;
  DeformedMessage deformed;
  deformed.parts = 2;
  deformed.index = {3, 5};
  deformed.position.resize(2);
  deformed.displacement.resize(2);
  deformed.strain.resize(2);
  FrameAssembler assembler;
  EXPECT_FALSE(assembler.take(regions));
  EXPECT_FALSE(assembler.take(deformed));
  deformed.part = 1;
  EXPECT_FALSE(assembler.take(deformed));
  EXPECT_EQ(assembler.incomplete(), 1);
  regions.frame = deformed.frame = 1;
  deformed.part = 0;
  EXPECT_FALSE(assembler.take(regions));
  EXPECT_FALSE(assembler.take(deformed));
  deformed.part = 1;
  deformed.index = {1, 9};
  EXPECT_TRUE(assembler.take(deformed));
  EXPECT_EQ(assembler.frame().deformed, (std::vector<std::int16_t>{1, 3, 5, 9}));
  EXPECT_EQ(assembler.incomplete(), 1);
}

TEST(FrameAssembler, PointsArePlacedByTheirRegionOrByThemselves) {
  SampleResult sample(1000, 10);
  TrackMessages messages(sample.rest, kSampleModelId);
  FrameAssembler assembler;
  ASSERT_EQ(feed(assembler, messages.encode(sample.result)), 1);
  std::vector<Point3f> places;
  ReceivedModel model = model_of(sample);
  place_points(assembler.frame(), model, places);
  ASSERT_EQ(places.size(), sample.rest.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    Vector3 expected = to_vector(sample.positions[i]);
    if (sample.labels[i] != kDeformed) {
      const std::size_t region = sample.labels[i] < 0 ? 0 : static_cast<std::size_t>(sample.labels[i]);
      expected = sample.regions[region].pose * to_vector(sample.rest[i]);
    }
    ASSERT_NEAR(static_cast<double>(places[i].x), expected.x(), 1e-6) << i;
    ASSERT_NEAR(static_cast<double>(places[i].z), expected.z(), 1e-6) << i;
  }
  model.model_id = 1;
  place_points(assembler.frame(), model, places);
  EXPECT_TRUE(places.empty()) << "another model's points have no place";
}

TEST(PictureAssembler, APictureComesBackAndOneWithAHoleDoesNot) {
  constexpr int kWidth = 640, kHeight = 300;
  std::vector<std::uint16_t> pixels(static_cast<std::size_t>(kWidth) * kHeight);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint16_t>(i * 7);
  Intrinsics camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.fx = camera.fy = 500;
  camera.cx = 320;
  camera.cy = 150;
  camera.depth_scale = 1000;
  DepthFrame frame;
  frame.depth = pixels.data();
  frame.width = frame.stride = kWidth;
  frame.height = kHeight;
  DepthMessages messages(kWidth, kHeight);
  PictureAssembler assembler;
  DepthMessage message;
  int pictures = 0;
  for (std::int64_t number = 0; number < 3; ++number) {
    frame.number = number;
    const auto bodies = messages.encode(frame, camera);
    ASSERT_GT(bodies.size(), 2U);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (number == 1 && i == 1) continue;
      ASSERT_TRUE(decode(bodies[i].bytes, message));
      pictures += assembler.take(message) ? 1 : 0;
    }
  }
  EXPECT_EQ(pictures, 2);
  EXPECT_EQ(assembler.incomplete(), 1);
  EXPECT_EQ(assembler.picture().frame, 2);
  EXPECT_EQ(assembler.picture().depth, pixels);
}

}  // namespace
}  // namespace pliant
