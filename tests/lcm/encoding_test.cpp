// The encoder's bytes, against the classes that lcm-gen makes of the types.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bot_core/rigid_transform_t.hpp"
#include "drivers/lcm/status_message.hpp"
#include "drivers/lcm/track_messages.hpp"
#include "pliant/deformed_t.hpp"
#include "pliant/regions_t.hpp"
#include "pliant/status_t.hpp"
#include "tests/lcm/sample_result.hpp"

namespace pliant {
namespace {

template <typename Message>
std::vector<std::uint8_t> generated_bytes(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return bytes;
}

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
  const std::size_t parts = (deformed_points + 599) / 600;
  const auto deformed = of_kind(bodies, MessageKind::deformed);
  ASSERT_EQ(deformed.size(), parts);
  for (std::size_t part = 0; part < parts; ++part) {
    EXPECT_EQ(bytes_of(*deformed[part]),
              generated_bytes(generated_deformed(sample, part * 600, (part + 1) * 600, static_cast<int>(part),
                                                 static_cast<int>(parts))))
        << part;
  }
}

TEST(LcmEncoding, NoMessageIsLargerThanSixteenThousandBytes) {
  for (const std::size_t points : {std::size_t{1}, std::size_t{600}, std::size_t{601}, std::size_t{10000},
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
  EXPECT_EQ(bytes_of(*deformed[0]), generated_bytes(generated_deformed(sample, 0, 600, 0, 1)));
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

StatusContent sample_status(std::span<const StageTimes> stages) {
  StatusContent content;
  content.utime = 1'700'000'000'000'001;
  content.version = "0.1.0";
  content.source = "recording:squirrel";
  content.model_id = kSampleModelId;
  content.frame = 99;
  content.state = TrackState::lost;
  content.device = DeviceState::reopening;
  content.rate = 29.97F;
  content.latency_median_us = 1500;
  content.latency_p99_us = 3000;
  content.latency_max_us = 12000;
  content.stages = stages;
  content.tracked = 1;
  content.searching = 2;
  content.lost = 3;
  content.dropped = 4;
  content.bad_frames = 5;
  content.stream_fault = StreamFault::delayed;
  content.zero_frames = 20;
  content.stuck_frames = 21;
  content.noise_frames = 22;
  content.wrong_size_frames = 23;
  content.delayed_frames = 24;
  content.slow_frames = 25;
  content.broken_frames = 26;
  content.stalls = 27;
  content.reopenings = 28;
  content.deadline_misses = 6;
  content.unsent = 7;
  content.send_failures = 8;
  content.workspace_bytes = 9;
  content.rss_bytes = 10;
  content.heap_calls = 11;
  content.page_faults = 12;
  content.last_error = "depth/000004.png: cut short";
  return content;
}

TEST(LcmEncoding, StatusIsWhatTheGeneratedClassWrites) {
  const std::vector<StageTimes> stages = {{"surface", 1, 2, 3}, {"align", 4, 5, 6}, {"total", 7, 8, 9}};
  const StatusContent content = sample_status(stages);
  status_t expected;
  expected.utime = content.utime;
  expected.version = "0.1.0";
  expected.source = "recording:squirrel";
  expected.model_id = static_cast<std::int64_t>(kSampleModelId);
  expected.frame = 99;
  expected.state = status_t::LOST;
  expected.device = status_t::DEVICE_REOPENING;
  expected.rate = 29.97F;
  expected.latency_median = 1500;
  expected.latency_p99 = 3000;
  expected.latency_max = 12000;
  expected.num_stages = 3;
  expected.stage = {"surface", "align", "total"};
  expected.stage_median = {1, 4, 7};
  expected.stage_p99 = {2, 5, 8};
  expected.stage_max = {3, 6, 9};
  expected.tracked = 1;
  expected.searching = 2;
  expected.lost = 3;
  expected.dropped = 4;
  expected.bad_frames = 5;
  expected.stream_fault = status_t::FAULT_DELAYED;
  expected.zero_frames = 20;
  expected.stuck_frames = 21;
  expected.noise_frames = 22;
  expected.wrong_size_frames = 23;
  expected.delayed_frames = 24;
  expected.slow_frames = 25;
  expected.broken_frames = 26;
  expected.stalls = 27;
  expected.reopenings = 28;
  expected.deadline_misses = 6;
  expected.unsent = 7;
  expected.send_failures = 8;
  expected.workspace_bytes = 9;
  expected.rss_bytes = 10;
  expected.heap_calls = 11;
  expected.page_faults = 12;
  expected.last_error = "depth/000004.png: cut short";
  std::vector<std::uint8_t> buffer(kMaxStatusBytes);
  const auto body = encode_status(content, buffer);
  EXPECT_EQ(std::vector<std::uint8_t>(body.begin(), body.end()), generated_bytes(expected));
}

TEST(LcmEncoding, StatusCutsWhatIsTooLongAndNeverOverruns) {
  const std::string long_text = std::string(254, 'x') + "é and more";  // the accent would be cut in half
  const std::vector<StageTimes> stages(40, StageTimes{long_text, 1, 2, 3});
  StatusContent content = sample_status(stages);
  content.version = long_text;
  content.source = long_text;
  content.last_error = long_text;
  std::vector<std::uint8_t> buffer(kMaxStatusBytes);
  const auto body = encode_status(content, buffer);
  ASSERT_FALSE(body.empty());
  status_t decoded;
  ASSERT_EQ(decoded.decode(body.data(), 0, static_cast<int>(body.size())), static_cast<int>(body.size()));
  EXPECT_EQ(decoded.last_error, std::string(254, 'x'));
  EXPECT_EQ(decoded.num_stages, static_cast<int>(kMaxStatusStages));
  EXPECT_EQ(decoded.stage[0].size(), kMaxStatusStageName);

  content.last_error = std::string_view("before\0behind", 13);
  const auto cut = encode_status(content, buffer);
  ASSERT_GT(decoded.decode(cut.data(), 0, static_cast<int>(cut.size())), 0);
  EXPECT_EQ(decoded.last_error, "before");

  std::vector<std::uint8_t> small(100);
  EXPECT_TRUE(encode_status(content, small).empty());
}

}  // namespace
}  // namespace pliant
