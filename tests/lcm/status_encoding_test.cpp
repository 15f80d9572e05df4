// The bytes of a status, against the class that lcm-gen makes of the type.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "drivers/lcm/status_message.hpp"
#include "pliant/status_t.hpp"
#include "tests/lcm/generated_bytes.hpp"
#include "tests/lcm/sample_result.hpp"

namespace pliant {
namespace {

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
  content.strain_energy = 0.125F;
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

TEST(LcmStatusEncoding, IsWhatTheGeneratedClassWrites) {
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
  expected.strain_energy = 0.125F;
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

TEST(LcmStatusEncoding, CutsWhatIsTooLongAndNeverOverruns) {
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
