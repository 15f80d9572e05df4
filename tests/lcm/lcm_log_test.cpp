// LCM logs, whole and damaged, and the depth pictures in them.
#include "drivers/lcm/lcm_log.hpp"

#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <lcm/lcm.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "drivers/lcm/depth_log.hpp"
#include "drivers/lcm/depth_messages.hpp"
#include "tests/temporary_folder.hpp"

namespace pliant {
namespace {

class Log : public testing::Test {
 protected:
  /// Pictures of 320 x 240, four messages each, by LCM's own writer; `left_out` of all messages is not sent.
  void write(int pictures, int left_out = -1) {
    lcm_t* lcm = lcm_create(("file://" + file_.string() + "?mode=w").c_str());
    ASSERT_NE(lcm, nullptr);
    DepthMessages messages(320, 240);
    int sent = 0;
    for (int i = 0; i < pictures; ++i) {
      std::vector<std::uint16_t> pixels(320 * 240, static_cast<std::uint16_t>(700 + i));
      const DepthFrame frame{pixels.data(), 320, 240, 320, 1'000'000 + i * 33'333, 50 + i};
      lcm_publish(lcm, "OTHER", "x", 1);
      for (const MessageBody& body : messages.encode(frame, kCamera))
        if (sent++ != left_out)
          lcm_publish(lcm, "PLIANT_DEPTH", body.bytes.data(), static_cast<unsigned>(body.bytes.size()));
    }
    lcm_destroy(lcm);
  }
  std::string bytes() const {
    std::ostringstream text;
    text << std::ifstream(file_, std::ios::binary).rdbuf();
    return text.str();
  }
  static int events_in(LcmLog& log) {
    LcmLogEvent event;
    int read = 0;
    while (log.next(event)) ++read;
    return read;
  }
  void write_bytes(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }

  static constexpr Intrinsics kCamera{320, 240, 285, 286, 159.5, 119.5, 1000};
  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "log";
};

TEST_F(Log, EveryMessageIsReadAsItWasSent) {
  write(3);
  Result<LcmLog> log = LcmLog::open(file_);
  ASSERT_TRUE(log) << log.error().message;
  LcmLogEvent event;
  int depth = 0, other = 0;
  for (std::int64_t number = 0; log->next(event); ++number) {
    EXPECT_EQ(event.number, number);
    ++(event.channel == "PLIANT_DEPTH" ? depth : other);
  }
  EXPECT_EQ(depth, 9);
  EXPECT_EQ(other, 3);
  EXPECT_EQ(log->damages(), 0);
}

TEST_F(Log, StampsNamesAndBodiesAreWhatLcmWrote) {
  lcm_eventlog_t* const log = lcm_eventlog_create(file_.c_str(), "w");
  ASSERT_NE(log, nullptr);
  for (std::size_t i = 0; i < 3; ++i) {
    std::string channel = "CHANNEL_" + std::to_string(i), data(i * 1000, static_cast<char>('a' + i));
    lcm_eventlog_event_t event{};
    event.timestamp = 1'700'000'000'000'000 + static_cast<std::int64_t>(i);
    event.channellen = static_cast<std::int32_t>(channel.size());
    event.datalen = static_cast<std::int32_t>(data.size());
    event.channel = channel.data();
    event.data = data.data();
    ASSERT_EQ(lcm_eventlog_write_event(log, &event), 0);
  }
  lcm_eventlog_destroy(log);
  Result<LcmLog> reader = LcmLog::open(file_);
  ASSERT_TRUE(reader) << reader.error().message;
  LcmLogEvent event;
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(reader->next(event));
    EXPECT_EQ(event.channel, "CHANNEL_" + std::to_string(i));
    EXPECT_EQ(event.utime, 1'700'000'000'000'000 + static_cast<std::int64_t>(i));
    EXPECT_EQ(event.body, std::vector<std::uint8_t>(i * 1000, static_cast<std::uint8_t>('a' + i)));
  }
  EXPECT_FALSE(reader->next(event));
  EXPECT_EQ(reader->damages(), 0);
}

TEST_F(Log, AFileCutShortEndsAtItsLastWholeEvent) {
  write(2);
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
  Result<LcmLog> log = LcmLog::open(file_);
  ASSERT_TRUE(log);
  EXPECT_EQ(events_in(*log), 7);
  EXPECT_EQ(log->damages(), 1);
}

TEST_F(Log, DamagedStretchesArePassedOver) {
  write(2);
  std::string text = bytes();
  const std::size_t second = text.find("PLIANT_DEPTH");
  text.replace(second - 8, 4, "\x7f\xff\xff\xff");  // the length of a channel's name
  write_bytes("\xED\xA1\xDA\x01 and rubbish" + text + std::string("\xED\xA1\xDA\x01\0\0", 6));
  Result<LcmLog> log = LcmLog::open(file_);
  ASSERT_TRUE(log);
  EXPECT_EQ(events_in(*log), 7);
  EXPECT_EQ(log->damages(), 3);
}

TEST_F(Log, PicturesComeBackWithStampsAndNumbers) {
  write(5);
  auto source = open_depth_log(file_);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->intrinsics().fy, 286);
  EXPECT_FALSE((*source)->live());
  SourceItem item;
  for (int i = 0; i < 5; ++i) {
    (*source)->next(10, item);
    ASSERT_EQ(item.event, SourceEvent::frame) << item.fault;
    EXPECT_EQ(item.frame.number, i);
    EXPECT_EQ(item.frame.utime, 1'000'000 + i * 33'333);
    EXPECT_EQ(item.frame.depth[0], 700 + i);
    EXPECT_EQ(item.frame.depth[320 * 240 - 1], 700 + i);
  }
  (*source)->next(10, item);
  EXPECT_EQ(item.event, SourceEvent::end);
}

TEST_F(Log, APictureWithAPartMissingIsBadAndTheOthersAreNot) {
  for (const int left_out : {4, 11}) {  // in the middle, and the very last
    write(4, left_out);
    auto source = open_depth_log(file_);
    ASSERT_TRUE(source);
    SourceItem item;
    std::string events;
    for (int i = 0; i < 5; ++i) {
      (*source)->next(10, item);
      events += item.event == SourceEvent::frame ? 'f' : item.event == SourceEvent::bad_frame ? 'b' : 'e';
    }
    EXPECT_EQ(events, left_out == 4 ? "fbffe" : "fffbe");
  }
}

TEST_F(Log, WhatIsNoLogOrHoldsNoDepthIsRefused) {
  const auto refusal = [this] {
    const auto source = open_depth_log(file_);
    EXPECT_FALSE(source);
    return source ? std::string() : source.error().message;
  };
  EXPECT_NE(refusal().find("No such file"), std::string::npos);
  write_bytes("");
  EXPECT_NE(refusal().find("is empty"), std::string::npos);
  write_bytes("not a log at all");
  EXPECT_NE(refusal().find("not an LCM log"), std::string::npos);
  write(0);
  lcm_t* lcm = lcm_create(("file://" + file_.string() + "?mode=w").c_str());
  lcm_publish(lcm, "PLIANT_DEPTH", "x", 1);
  lcm_destroy(lcm);
  EXPECT_NE(refusal().find("no depth pictures"), std::string::npos);
}

}  // namespace
}  // namespace pliant
