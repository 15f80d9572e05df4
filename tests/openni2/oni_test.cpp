// .oni recordings, made by the library's recorder and played by its driver.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "drivers/openni2/openni2.hpp"
#include "tests/openni2/sensor_rig.hpp"

namespace pliant::test {
namespace {

class Oni : public testing::Test {
 protected:
  Result<std::unique_ptr<DepthSource>> open(const std::filesystem::path& file) {
    auto library = OpenNi2Library::start();
    if (!library) return library.error();
    return open_oni(*library, file, {});
  }
  SensorRig rig_;
};

TEST_F(Oni, EveryFramePlaysBitForBitAndTheEndIsTold) {
  rig_.control().rate = 60;
  const std::filesystem::path file = rig_.folder() / "twelve.oni";
  rig_.record_oni(file, 12);
  for (int round = 0; round < 2; ++round) {
    auto source = open(file);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_FALSE((*source)->live());
    EXPECT_GE((*source)->frame_count(), 12);
    const Intrinsics& camera = (*source)->intrinsics();
    EXPECT_EQ(camera.width, 320);
    EXPECT_EQ(camera.height, 240);
    EXPECT_NEAR(camera.fx, 285, 0.01);
    EXPECT_NEAR(camera.fy, 285, 0.01);
    EXPECT_EQ(camera.cx, 159.5);
    SourceItem item;
    std::int64_t count = 0, before = -1;
    for (;;) {
      (*source)->next(2000, item);
      if (item.event != SourceEvent::frame) break;
      ASSERT_EQ(item.frame.number, count);
      ASSERT_EQ(item.frame.stride, 320);
      EXPECT_GT(item.frame.utime, before);
      before = item.frame.utime;
      const std::uint16_t* expected = rig_.frame(static_cast<int>(count < 20 ? count : 38 - count));
      ASSERT_EQ(std::memcmp(item.frame.depth, expected, 320 * 240 * 2), 0) << "frame " << count;
      ++count;
    }
    EXPECT_EQ(item.event, SourceEvent::end);
    EXPECT_EQ(count, (*source)->frame_count());
    (*source)->next(10, item);
    EXPECT_EQ(item.event, SourceEvent::end);
  }
}

TEST_F(Oni, ClosingAtTheEndOrOnTheWayHarmsNothing) {
  rig_.control().rate = 200;
  const std::filesystem::path file = rig_.folder() / "short.oni";
  rig_.record_oni(file, 4);
  for (int round = 0; round < 40; ++round) {
    auto source = open(file);
    ASSERT_TRUE(source) << source.error().message;
    const std::int64_t taken = round % 4 == 3 ? 2 : (*source)->frame_count();
    SourceItem item;
    for (std::int64_t i = 0; i < taken; ++i) {
      (*source)->next(2000, item);
      ASSERT_EQ(item.event, SourceEvent::frame) << "round " << round;
    }
    if (round % 2 == 0) {
      (*source)->next(2000, item);
      EXPECT_EQ(item.event, SourceEvent::end);
    }
  }
}

TEST_F(Oni, WhatIsNoRecordingIsRefusedWithTheReason) {
  const auto refusal = [this](const std::filesystem::path& file) {
    const auto source = open(file);
    EXPECT_FALSE(source);
    if (source) return std::string("it was opened");
    EXPECT_EQ(source.error().kind, ErrorKind::bad_input);
    EXPECT_NE(source.error().message.find(file.filename().string()), std::string::npos);
    return source.error().message;
  };
  EXPECT_NE(refusal(rig_.folder() / "none.oni").find("No such file"), std::string::npos);
  EXPECT_NE(refusal(rig_.folder()).find("folder"), std::string::npos);
  ASSERT_EQ(mkfifo((rig_.folder() / "pipe.oni").c_str(), 0600), 0);
  EXPECT_NE(refusal(rig_.folder() / "pipe.oni").find("a device or a pipe"), std::string::npos);
  std::ofstream(rig_.folder() / "text.oni") << "just a text that is long enough";
  EXPECT_NE(refusal(rig_.folder() / "text.oni").find("not an .oni recording"), std::string::npos);

  rig_.control().rate = 60;
  const std::filesystem::path file = rig_.folder() / "whole.oni";
  rig_.record_oni(file, 5);
  std::filesystem::resize_file(file, 100'000);
  EXPECT_NE(refusal(file).find("cut short"), std::string::npos);
  std::filesystem::resize_file(file, 30);
  EXPECT_NE(refusal(file).find("cut short at byte 24"), std::string::npos);
}

TEST_F(Oni, ARecordingWithAHoleIsRefused) {
  rig_.control().rate = 60;
  const std::filesystem::path file = rig_.folder() / "hole.oni";
  rig_.record_oni(file, 5);
  {
    std::fstream edit(file, std::ios::in | std::ios::out | std::ios::binary);
    edit.seekp(24 + 74);  // the second record
    edit << "XXXX";
  }
  const auto source = open(file);
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().message.find("damaged at byte 98"), std::string::npos) << source.error().message;
}

/// Plays the file in a process of its own: 0 it played or was refused, else the signal that ended it.
int play_apart(const std::filesystem::path& file) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);  // a hang ends with SIGALRM
    auto library = OpenNi2Library::start();
    if (!library) _exit(0);
    auto source = open_oni(*library, file, {});
    if (!source) _exit(0);
    SourceItem item;
    do (*source)->next(500, item);
    while (item.event != SourceEvent::end && item.event != SourceEvent::lost);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

TEST_F(Oni, DamagedRecordingsAreRefusedOrPlayedAndNeverCrashTheLibrary) {
  rig_.control().rate = 60;
  const std::filesystem::path file = rig_.folder() / "whole.oni", damaged = rig_.folder() / "damaged.oni";
  rig_.record_oni(file, 5);
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  const std::string whole = text.str();
  std::mt19937 random(5);  // NOLINT(cert-msc51-cpp): the same damage in every run
  for (int i = 0; i < 80; ++i) {
    std::string bytes = whole;
    std::string flipped;
    for (int k = 0; k <= i % 3; ++k) {
      const std::size_t within = random() % 5 == 0 ? bytes.size() : 1060;  // mostly where descriptions stand
      const std::size_t at = random() % within;
      const auto bit = static_cast<unsigned>(random() % 8);
      bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ (1U << bit));
      flipped += " bit " + std::to_string(bit) + " of byte " + std::to_string(at);
    }
    std::ofstream(damaged, std::ios::binary) << bytes;
    EXPECT_EQ(play_apart(damaged), 0) << flipped;
  }
}

}  // namespace
}  // namespace pliant::test
