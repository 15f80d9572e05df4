// The bytes of a frame's messages, against the classes that lcm-gen makes of the types.
#include <gtest/gtest.h>

#include <vector>

#include "bot_core/rigid_transform_t.hpp"
#include "drivers/lcm/track_messages.hpp"
#include "pliant/deformed_t.hpp"
#include "pliant/regions_t.hpp"
#include "tests/lcm/generated_bytes.hpp"
#include "tests/lcm/sample_result.hpp"

namespace pliant {
namespace {

std::vector<std::uint8_t> bytes_of(const MessageBody& body) {
  return {body.bytes.begin(), body.bytes.end()};
}

std::vector<const MessageBody*> of_kind(std::span<const MessageBody> bodies, MessageKind kind) {
  std::vector<const MessageBody*> found;
  for (const MessageBody& body : bodies) {
    if (body.kind == kind) found.push_back(&body);
  }
  return found;
}

void copy_transform(const RigidTransform& transform, double (&trans)[3], double (&quat)[4]) {
  for (int i = 0; i < 3; ++i) trans[i] = transform.translation[i];
  const Quaternion q = quaternion_from_rotation(transform.rotation);
  quat[0] = q.w;
  quat[1] = q.x;
  quat[2] = q.y;
  quat[3] = q.z;
}

regions_t generated_regions(const SampleResult& sample, std::size_t first, std::size_t count, int part,
                            int parts) {
  regions_t message;
  message.utime = sample.result.utime;
  message.frame = sample.result.frame;
  message.model_id = static_cast<std::int64_t>(kSampleModelId);
  message.state = regions_t::TRACKING;
  message.confidence = sample.result.confidence;
  message.part = static_cast<std::int16_t>(part);
  message.parts = static_cast<std::int16_t>(parts);
  for (const Region& region : sample.regions) {
    region_t item;
    item.id = region.id;
    item.parent = region.parent;
    item.points = static_cast<std::int32_t>(region.points);
    item.rms = region.rms;
    item.confidence = region.confidence;
    copy_transform(region.pose, item.trans, item.quat);
    item.joint[0] = region.joint.x;
    item.joint[1] = region.joint.y;
    item.joint[2] = region.joint.z;
    message.regions.push_back(item);
  }
  message.num_regions = static_cast<std::int32_t>(message.regions.size());
  message.model_points = static_cast<std::int32_t>(sample.rest.size());
  message.first_point = static_cast<std::int32_t>(first);
  message.num_labels = static_cast<std::int32_t>(count);
  message.labels.assign(sample.labels.begin() + static_cast<std::ptrdiff_t>(first),
                        sample.labels.begin() + static_cast<std::ptrdiff_t>(first + count));
  return message;
}

/// One message that holds all deformed points from the `first`-th to before the `end`-th.
deformed_t generated_deformed(const SampleResult& sample, std::size_t first, std::size_t end, int part,
                              int parts) {
  deformed_t message;
  message.utime = sample.result.utime;
  message.frame = sample.result.frame;
  message.model_id = static_cast<std::int64_t>(kSampleModelId);
  message.part = static_cast<std::int16_t>(part);
  message.parts = static_cast<std::int16_t>(parts);
  message.num_deformed = 0;
  for (std::size_t i = 0; i < sample.rest.size(); ++i) {
    if (sample.labels[i] != regions_t::DEFORMED) continue;
    const auto rank = static_cast<std::size_t>(message.num_deformed++);
    if (rank < first || rank >= end) continue;
    const Point3f& p = sample.positions[i];
    const Point3f& r = sample.rest[i];
    const Vector3 carried = sample.result.pose * Vector3(r.x, r.y, r.z);
    const Vector3 displacement = Vector3(p.x, p.y, p.z) - carried;
    message.index.push_back(static_cast<std::int16_t>(i));
    message.position.push_back({p.x, p.y, p.z});
    message.displacement.push_back({static_cast<float>(displacement.x()),
                                    static_cast<float>(displacement.y()),
                                    static_cast<float>(displacement.z())});
    message.strain.push_back(sample.strains[i]);
  }
  message.num_points = static_cast<std::int32_t>(message.index.size());
  return message;
}

TEST(LcmEncoding, PoseIsWhatTheGeneratedClassWrites) {
  const SampleResult sample(50);
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto bodies = messages.encode(sample.result);
  bot_core::rigid_transform_t pose;
  pose.utime = sample.result.utime;
  copy_transform(sample.result.pose, pose.trans, pose.quat);
  ASSERT_FALSE(bodies.empty());
  EXPECT_EQ(bodies[0].kind, MessageKind::pose);
  EXPECT_EQ(bytes_of(bodies[0]), generated_bytes(pose));
}

TEST(LcmEncoding, RegionsAndDeformedAreWhatTheGeneratedClassesWrite) {
  const SampleResult sample(1200);
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto bodies = messages.encode(sample.result);
  ASSERT_EQ(bodies.size(), 3U);
  EXPECT_EQ(bodies[1].kind, MessageKind::regions);
  EXPECT_EQ(bytes_of(bodies[1]), generated_bytes(generated_regions(sample, 0, 1200, 0, 1)));
  EXPECT_EQ(bodies[2].kind, MessageKind::deformed);
  EXPECT_EQ(bytes_of(bodies[2]), generated_bytes(generated_deformed(sample, 0, 120, 0, 1)));
}

TEST(LcmEncoding, EveryConfidenceIsLessenedByTheTrust) {
  const SampleResult sample(50);
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto bodies = messages.encode(sample.result, 0.25F);
  regions_t expected = generated_regions(sample, 0, 50, 0, 1);
  expected.confidence *= 0.25F;
  for (region_t& region : expected.regions) region.confidence *= 0.25F;
  ASSERT_EQ(bodies.size(), 3U);
  EXPECT_EQ(bytes_of(bodies[1]), generated_bytes(expected));
}

TEST(LcmEncoding, LargeModelsGoInPartsThatAreWholeMessages) {
  const SampleResult sample(limits::kMaxModelPoints, 3, limits::kMaxRegions);
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto bodies = messages.encode(sample.result);
  const auto regions = of_kind(bodies, MessageKind::regions);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(bytes_of(*regions[0]), generated_bytes(generated_regions(sample, 0, 15000, 0, 2)));
  EXPECT_EQ(bytes_of(*regions[1]),
            generated_bytes(generated_regions(sample, 15000, limits::kMaxModelPoints - 15000, 1, 2)));

  const std::size_t deformed_points = (limits::kMaxModelPoints + 2) / 3;
  constexpr std::size_t kPerPart = 530;
  const std::size_t parts = (deformed_points + kPerPart - 1) / kPerPart;
  const auto deformed = of_kind(bodies, MessageKind::deformed);
  ASSERT_EQ(deformed.size(), parts);
  for (std::size_t part = 0; part < parts; ++part) {
    EXPECT_EQ(bytes_of(*deformed[part]),
              generated_bytes(generated_deformed(sample, part * kPerPart, (part + 1) * kPerPart,
                                                 static_cast<int>(part), static_cast<int>(parts))))
        << part;
  }
}

TEST(LcmEncoding, NoMessageIsLargerThanSixteenThousandBytes) {
  for (const std::size_t points : {std::size_t{1}, std::size_t{530}, std::size_t{531}, std::size_t{10000},
                                   std::size_t{15000}, std::size_t{15001}, limits::kMaxModelPoints}) {
    for (const std::size_t deformed_every : {0U, 1U, 7U}) {
      const SampleResult sample(points, deformed_every, limits::kMaxRegions);
      TrackMessages messages(sample.rest, kSampleModelId);
      const auto bodies = messages.encode(sample.result);
      std::size_t total = 0;
      for (const MessageBody& body : bodies) {
        EXPECT_LE(body.bytes.size(), kMaxMessageBytes);
        total += body.bytes.size();
      }
      EXPECT_LE(total, TrackMessages::max_bytes(points));
      EXPECT_LE(bodies.size(), TrackMessages::max_bodies(points));
      if (points == 10000) {
        EXPECT_EQ(of_kind(bodies, MessageKind::regions).size(), 1U);
      }
    }
  }
}

TEST(LcmEncoding, NothingDeformedIsAMessageWithoutPoints) {
  const SampleResult sample(300, 0);
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto deformed = of_kind(messages.encode(sample.result), MessageKind::deformed);
  ASSERT_EQ(deformed.size(), 1U);
  EXPECT_EQ(bytes_of(*deformed[0]), generated_bytes(generated_deformed(sample, 0, 1, 0, 1)));
}

TEST(LcmEncoding, WhileNotTrackedOnlyRegionsSpeak) {
  SampleResult sample(300);
  TrackMessages messages(sample.rest, kSampleModelId);
  for (const TrackState state : {TrackState::searching, TrackState::lost}) {
    sample.lose(state);
    const auto bodies = messages.encode(sample.result);
    ASSERT_EQ(bodies.size(), 1U);
    regions_t expected;
    expected.utime = sample.result.utime;
    expected.frame = sample.result.frame;
    expected.model_id = static_cast<std::int64_t>(kSampleModelId);
    expected.state = state == TrackState::lost ? regions_t::LOST : regions_t::SEARCHING;
    expected.confidence = 0;
    expected.part = 0;
    expected.parts = 1;
    expected.num_regions = 0;
    expected.model_points = 300;
    expected.first_point = 0;
    expected.num_labels = 0;
    EXPECT_EQ(bytes_of(bodies[0]), generated_bytes(expected));
  }
}

TEST(LcmEncoding, AFrameThatWasNotUsedIsNotAnnounced) {
  SampleResult sample(300);
  sample.result.frame_used = false;
  TrackMessages messages(sample.rest, kSampleModelId);
  EXPECT_TRUE(messages.encode(sample.result).empty());
}

TEST(LcmEncoding, ABaseOutOfSightHasNoPose) {
  SampleResult sample(300);
  sample.regions.erase(sample.regions.begin());
  sample.attach();
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto bodies = messages.encode(sample.result);
  EXPECT_TRUE(of_kind(bodies, MessageKind::pose).empty());
  EXPECT_EQ(of_kind(bodies, MessageKind::regions).size(), 1U);
  EXPECT_EQ(of_kind(bodies, MessageKind::deformed).size(), 1U);
}

TEST(LcmEncoding, TheSameResultGivesTheSameBytes) {
  const SampleResult sample(2000, 2);
  const SampleResult other(2000, 5);
  TrackMessages messages(sample.rest, kSampleModelId);
  std::vector<std::vector<std::uint8_t>> first;
  for (const MessageBody& body : messages.encode(sample.result)) first.push_back(bytes_of(body));
  static_cast<void>(messages.encode(other.result));
  std::vector<std::vector<std::uint8_t>> again;
  for (const MessageBody& body : messages.encode(sample.result)) again.push_back(bytes_of(body));
  EXPECT_EQ(first, again);
}

}  // namespace
}  // namespace pliant
