// Decoding: what was sent comes back, and what a network may bring otherwise is refused without harm.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "drivers/lcm/messages.hpp"
#include "drivers/lcm/status_message.hpp"
#include "drivers/lcm/track_messages.hpp"
#include "tests/lcm/sample_result.hpp"

namespace pliant {
namespace {

struct Samples {
  SampleResult sample{400, 7};
  TrackMessages messages{sample.rest, kSampleModelId};
  std::vector<std::vector<std::uint8_t>> bodies;  // by MessageKind

  Samples() {
    for (const MessageBody& body : messages.encode(sample.result)) {
      bodies.emplace_back(body.bytes.begin(), body.bytes.end());
    }
    const std::vector<StageTimes> stages = {{"surface", 1, 2, 3}, {"total", 4, 5, 6}};
    StatusContent content;
    content.utime = 5;
    content.version = "0.1.0";
    content.last_error = "none";
    content.strain_energy = 0.375F;
    content.stages = stages;
    std::vector<std::uint8_t> buffer(kMaxStatusBytes);
    const auto status = encode_status(content, buffer);
    bodies.emplace_back(status.begin(), status.end());
  }
};

bool decodes(MessageKind kind, std::span<const std::uint8_t> body) {
  PoseMessage pose;
  RegionsMessage regions;
  DeformedMessage deformed;
  StatusMessage status;
  DepthMessage depth;
  ModelMessage model;
  switch (kind) {
    case MessageKind::pose:
      return decode(body, pose);
    case MessageKind::regions:
      return decode(body, regions);
    case MessageKind::deformed:
      return decode(body, deformed);
    case MessageKind::status:
      return decode(body, status);
    case MessageKind::depth:
      return decode(body, depth);
    case MessageKind::model:
      return decode(body, model);
  }
  return false;
}

constexpr int kSampled = 4;  // kinds in Samples; depth and model have their own tests

TEST(LcmDecoding, BringsBackWhatWasEncoded) {
  const Samples samples;
  const SampleResult& sample = samples.sample;
  PoseMessage pose;
  ASSERT_TRUE(decode(samples.bodies[0], pose));
  EXPECT_EQ(pose.utime, sample.result.utime);
  const Matrix3 rotation = rotation_from_quaternion({pose.quat[0], pose.quat[1], pose.quat[2], pose.quat[3]});
  EXPECT_LT((rotation - sample.result.pose.rotation).norm(), 1e-12);
  EXPECT_EQ(Vector3(pose.trans[0], pose.trans[1], pose.trans[2]), sample.result.pose.translation);

  RegionsMessage regions;
  ASSERT_TRUE(decode(samples.bodies[1], regions));
  EXPECT_EQ(regions.frame, 4711);
  EXPECT_EQ(static_cast<std::uint64_t>(regions.model_id), kSampleModelId);
  EXPECT_EQ(regions.state, TrackState::tracking);
  EXPECT_EQ(regions.labels, sample.labels);
  ASSERT_EQ(regions.regions.size(), 3U);
  EXPECT_EQ(regions.regions[2].id, 2);
  EXPECT_EQ(regions.regions[2].parent, 0);
  EXPECT_EQ(regions.regions[2].points, 1002);
  EXPECT_FALSE(regions.regions[0].joint) << "the base hangs on nothing";
  ASSERT_TRUE(regions.regions[1].joint);
  EXPECT_EQ(regions.regions[1].joint->x, sample.regions[1].joint.x);
  EXPECT_EQ(regions.regions[1].joint->y, sample.regions[1].joint.y);
  EXPECT_EQ(regions.regions[1].joint->z, sample.regions[1].joint.z);
  EXPECT_FALSE(regions.regions[2].joint) << "does not touch its parent";

  DeformedMessage deformed;
  ASSERT_TRUE(decode(samples.bodies[2], deformed));
  EXPECT_EQ(deformed.num_deformed, 58);
  ASSERT_EQ(deformed.strain.size(), 58U);
  ASSERT_EQ(deformed.index.size(), 58U);
  for (std::size_t k = 0; k < deformed.index.size(); ++k) {
    const auto i = static_cast<std::size_t>(deformed.index[k]);
    EXPECT_EQ(i, 7 * k);
    EXPECT_EQ(deformed.position[k].z, sample.positions[i].z);
    EXPECT_EQ(deformed.strain[k], sample.strains[i]);
    // Position minus displacement is where the base's motion puts the point.
    const Vector3 carried =
        sample.result.pose * Vector3(sample.rest[i].x, sample.rest[i].y, sample.rest[i].z);
    EXPECT_NEAR(static_cast<double>(deformed.position[k].x - deformed.displacement[k].x), carried.x(), 1e-6);
    EXPECT_NEAR(static_cast<double>(deformed.position[k].y - deformed.displacement[k].y), carried.y(), 1e-6);
    EXPECT_NEAR(static_cast<double>(deformed.position[k].z - deformed.displacement[k].z), carried.z(), 1e-6);
  }

  StatusMessage status;
  ASSERT_TRUE(decode(samples.bodies[3], status));
  EXPECT_EQ(status.version, "0.1.0");
  EXPECT_EQ(status.last_error, "none");
  EXPECT_EQ(status.strain_energy, 0.375F);
  ASSERT_EQ(status.stages.size(), 2U);
  EXPECT_EQ(status.stages[1].name, "total");
  EXPECT_EQ(status.stages[1].p99, 5);
}

TEST(LcmDecoding, RefusesEveryCutAndEveryByteTooMany) {
  const Samples samples;
  for (int kind = 0; kind < kSampled; ++kind) {
    const auto& body = samples.bodies[static_cast<std::size_t>(kind)];
    for (std::size_t length = 0; length < body.size(); ++length) {
      // A copy of its own size: reading beyond it shows under a sanitizer.
      const std::vector<std::uint8_t> cut(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(length));
      ASSERT_FALSE(decodes(static_cast<MessageKind>(kind), cut)) << kind << " cut to " << length;
    }
    auto longer = body;
    longer.push_back(0);
    EXPECT_FALSE(decodes(static_cast<MessageKind>(kind), longer));
    EXPECT_FALSE(decodes(static_cast<MessageKind>((kind + 1) % kMessageKinds), body));
  }
}

TEST(LcmDecoding, SurvivesRandomDamage) {
  const Samples samples;
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp): the same damage in every run
  for (int round = 0; round < 20000; ++round) {
    const int kind = round % kSampled;
    auto body = samples.bodies[static_cast<std::size_t>(kind)];
    const std::size_t damages = 1 + random() % 4;
    for (std::size_t k = 0; k < damages; ++k) {
      body[8 + random() % (body.size() - 8)] = static_cast<std::uint8_t>(random());
    }
    static_cast<void>(decodes(static_cast<MessageKind>(kind), body));
  }
}

/// Puts big-endian bytes into a copy of a body.
template <typename T>
std::vector<std::uint8_t> with(std::vector<std::uint8_t> body, std::size_t offset, T value) {
  std::vector<std::uint8_t> bytes(sizeof(T));
  std::memcpy(bytes.data(), &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::little) std::reverse(bytes.begin(), bytes.end());
  std::copy(bytes.begin(), bytes.end(), body.begin() + static_cast<std::ptrdiff_t>(offset));
  return body;
}

TEST(LcmDecoding, RefusesCountsAndNumbersOutOfRange) {
  const Samples samples;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity(), no_number = static_cast<float>(nan);
  const auto& pose = samples.bodies[0];
  EXPECT_FALSE(decodes(MessageKind::pose, with(pose, 16, nan)));
  EXPECT_FALSE(decodes(MessageKind::pose, with(pose, 40, 3.0))) << "not a unit quaternion";

  const auto& regions = samples.bodies[1];
  constexpr std::size_t kState = 32, kPart = 37, kParts = 39, kCount = 41;
  EXPECT_TRUE(decodes(MessageKind::regions, with<std::int8_t>(regions, kState, 2)));
  EXPECT_FALSE(decodes(MessageKind::regions, with<std::int8_t>(regions, kState, 3)));
  EXPECT_FALSE(decodes(MessageKind::regions, with<std::int8_t>(regions, kState, -1)));
  EXPECT_FALSE(decodes(MessageKind::regions, with<std::int16_t>(regions, kPart, 1))) << "part beyond parts";
  EXPECT_FALSE(decodes(MessageKind::regions, with<std::int16_t>(regions, kParts, 0)));
  for (const std::int32_t count : {-1, 4, 9, 1 << 30, std::numeric_limits<std::int32_t>::max()}) {
    EXPECT_FALSE(decodes(MessageKind::regions, with(regions, kCount, count))) << count;
  }
  const std::size_t labels = regions.size() - 400;
  EXPECT_FALSE(decodes(MessageKind::regions, with<std::int8_t>(regions, labels, -3)));
  EXPECT_FALSE(decodes(MessageKind::regions, with<std::int32_t>(regions, labels - 8, 1)))
      << "labels beyond the model";
  constexpr std::size_t kJoint = 45 + 82 + 70;  // of the second region, which hangs on the base
  for (const float wrong : {infinite, no_number})
    EXPECT_FALSE(decodes(MessageKind::regions, with(regions, kJoint, wrong))) << wrong;
  const auto untied =
      with(with(with(regions, kJoint, no_number), kJoint + 4, no_number), kJoint + 8, no_number);
  EXPECT_TRUE(decodes(MessageKind::regions, untied)) << "a joint may be none as a whole";

  const auto& deformed = samples.bodies[2];
  constexpr std::size_t kDeformed = 36, kPoints = 40, kIndices = 44;
  EXPECT_FALSE(decodes(MessageKind::deformed, with<std::int32_t>(deformed, kDeformed, 57)));
  EXPECT_FALSE(decodes(MessageKind::deformed, with<std::int32_t>(deformed, kPoints, -5)));
  EXPECT_FALSE(decodes(MessageKind::deformed, with<std::int16_t>(deformed, kIndices, -1)));
  EXPECT_FALSE(decodes(MessageKind::deformed, with<std::int16_t>(deformed, kIndices, 100)))
      << "not ascending";
  EXPECT_FALSE(
      decodes(MessageKind::deformed, with<std::int16_t>(deformed, kIndices + std::size_t{57} * 2, 16384)));
  EXPECT_FALSE(decodes(MessageKind::deformed, with(deformed, kIndices + std::size_t{58} * 2, infinite)));
  const std::size_t strain = kIndices + std::size_t{58} * (2 + 12 + 12);
  EXPECT_TRUE(decodes(MessageKind::deformed, with(deformed, strain, 0.5F)));
  for (const float wrong : {-0.5F, infinite, no_number})
    EXPECT_FALSE(decodes(MessageKind::deformed, with(deformed, strain, wrong))) << wrong;

  const auto& status = samples.bodies[3];
  EXPECT_FALSE(decodes(MessageKind::status, with<std::int32_t>(status, 16, 0)))
      << "a string has its closing zero";
  EXPECT_FALSE(decodes(MessageKind::status, with<std::int32_t>(status, 16, -1)));
  EXPECT_FALSE(decodes(MessageKind::status, with<std::int32_t>(status, 16, 1 << 30)));
  EXPECT_FALSE(decodes(MessageKind::status, with<std::uint8_t>(status, 21, 0))) << "a zero inside a string";
  // Behind the fingerprint, the time, "0.1.0" and "" with their lengths and zeros, ids, states and the rate.
  constexpr std::size_t kEnergy = 8 + 8 + (4 + 6) + (4 + 1) + 8 + 8 + 3 + 4;
  EXPECT_TRUE(decodes(MessageKind::status, with(status, kEnergy, 2.0F)));
  for (const float wrong : {-0.5F, infinite, no_number})
    EXPECT_FALSE(decodes(MessageKind::status, with(status, kEnergy, wrong))) << wrong;
}

}  // namespace
}  // namespace pliant
