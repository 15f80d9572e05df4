// Logs as LCM itself writes them, and files that are none.
#include "drivers/lcm/event_log.hpp"

#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace pliant {
namespace {

class EventLog : public ::testing::Test {
 protected:
  EventLog()
      : path_(std::filesystem::temp_directory_path() / ("pliant_log_test_" + std::to_string(::getpid()))) {}
  ~EventLog() override { std::filesystem::remove(path_); }
  void write_with_lcm() const {
    lcm_eventlog_t* const log = lcm_eventlog_create(path_.c_str(), "w");
    ASSERT_NE(log, nullptr);
    for (int i = 0; i < 3; ++i) {
      std::string channel = "CHANNEL_" + std::to_string(i);
      std::string data(static_cast<std::size_t>(i) * 1000, static_cast<char>('a' + i));
      lcm_eventlog_event_t event{};
      event.timestamp = 1'700'000'000'000'000 + i;
      event.channellen = static_cast<std::int32_t>(channel.size());
      event.datalen = static_cast<std::int32_t>(data.size());
      event.channel = channel.data();
      event.data = data.data();
      ASSERT_EQ(lcm_eventlog_write_event(log, &event), 0);
    }
    lcm_eventlog_destroy(log);
  }
  std::filesystem::path path_;
};

TEST_F(EventLog, ReadsWhatLcmWrote) {
  write_with_lcm();
  auto reader = EventLogReader::open(path_.string());
  ASSERT_TRUE(reader) << reader.error().message;
  LoggedEvent event;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(reader->next(event));
    EXPECT_EQ(event.channel, "CHANNEL_" + std::to_string(i));
    EXPECT_EQ(event.received_us, 1'700'000'000'000'000 + i);
    EXPECT_EQ(event.body, std::vector<std::uint8_t>(static_cast<std::size_t>(i) * 1000,
                                                    static_cast<std::uint8_t>('a' + i)));
  }
  EXPECT_FALSE(reader->next(event));
  EXPECT_FALSE(reader->damaged());
}

TEST_F(EventLog, AFileCutShortEndsAtItsLastWholeEvent) {
  write_with_lcm();
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  auto reader = EventLogReader::open(path_.string());
  ASSERT_TRUE(reader);
  LoggedEvent event;
  EXPECT_TRUE(reader->next(event));
  EXPECT_TRUE(reader->next(event));
  EXPECT_FALSE(reader->next(event));
  EXPECT_TRUE(reader->damaged());
}

TEST_F(EventLog, WhatIsNoLogIsRefused) {
  EXPECT_NE(EventLogReader::open("/nowhere/x.log").error().message.find("/nowhere/x.log"), std::string::npos);
  std::ofstream(path_) << "";
  EXPECT_NE(EventLogReader::open(path_.string()).error().message.find("empty"), std::string::npos);
  std::ofstream(path_) << "ply\n";
  EXPECT_NE(EventLogReader::open(path_.string()).error().message.find("not an LCM log"), std::string::npos);
}

}  // namespace
}  // namespace pliant
