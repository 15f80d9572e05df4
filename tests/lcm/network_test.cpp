// Over real multicast, in a network of the test's own.
#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "drivers/lcm/frame_assembler.hpp"
#include "drivers/lcm/multicast_probe.hpp"
#include "drivers/lcm/publisher.hpp"
#include "drivers/lcm/subscriber.hpp"
#include "tests/lcm/heap_counter.hpp"
#include "tests/lcm/network_namespace.hpp"
#include "tests/lcm/sample_result.hpp"

namespace pliant {
namespace {

using std::chrono::milliseconds;

class LcmNetwork : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { fault_ = enter_network_namespace(); }
  void SetUp() override {
    if (fault_ != nullptr) GTEST_SKIP() << fault_;
  }
  static const char* fault_;
};
const char* LcmNetwork::fault_ = nullptr;

const LcmSettings kSettings = {.url = std::string(kDefaultLcmUrl), .prefix = "PLIANT"};

/// Handles messages until `done` or ten seconds are over.
template <typename Done>
bool handle_until(LcmSubscriber& subscriber, const Done& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!done() && std::chrono::steady_clock::now() < end) subscriber.handle(20);
  return done();
}

TEST_F(LcmNetwork, EveryMessageOfATrackedSecondArrives) {
  SampleResult sample(10000, 5);
  TrackMessages messages(sample.rest, kSampleModelId);
  auto subscriber = LcmSubscriber::create(kSettings.url, "PLIANT");
  ASSERT_TRUE(subscriber) << subscriber.error().message;
  auto publisher = LcmPublisher::create(kSettings, 10000);
  ASSERT_TRUE(publisher) << publisher.error().message;
  EXPECT_EQ((*publisher)->warning(), "");
  EXPECT_TRUE((*publisher)->connected());
  std::int64_t sent = 0;
  for (int frame = 0; frame < 30; ++frame) {
    sample.result.frame = frame;
    const auto bodies = messages.encode(sample.result);
    sent += std::ssize(bodies);
    (*publisher)->publish(bodies, frame);
    const auto end = std::chrono::steady_clock::now() + milliseconds(33);
    while (std::chrono::steady_clock::now() < end) (*subscriber)->handle(5);
  }
  EXPECT_TRUE(handle_until(**subscriber, [&] { return (*subscriber)->counters().total() >= sent; }));
  EXPECT_EQ((*subscriber)->counters().total(), sent);
  EXPECT_EQ((*subscriber)->counters().garbage, 0);
  EXPECT_EQ((*publisher)->counters().failures, 0);
}

TEST_F(LcmNetwork, NeitherHandingOverNorSendingTouchesTheHeap) {
  if (!heap_calls_are_counted()) GTEST_SKIP() << "a sanitizer has the heap";
  struct SendingThread {
    std::atomic<std::int64_t> at_start{-1}, now{-1};
    std::atomic<int> groups{0};
  } sending;
  SendObserver observer;
  observer.context = &sending;
  observer.thread_started = [](void* context) {
    static_cast<SendingThread*>(context)->at_start = heap_calls_of_this_thread();
  };
  observer.group_sent = [](void* context, std::int64_t) {
    auto& it = *static_cast<SendingThread*>(context);
    it.now = heap_calls_of_this_thread();
    ++it.groups;
  };
  const SampleResult sample(10000, 3);
  TrackMessages messages(sample.rest, kSampleModelId);
  auto publisher = LcmPublisher::create(kSettings, 10000, observer);
  ASSERT_TRUE(publisher);

  const std::int64_t before = heap_calls_of_this_thread();
  for (int frame = 0; frame < 50; ++frame) {
    (*publisher)->publish(messages.encode(sample.result), frame);
    StatusContent status;
    status.version = "0.1.0";
    (*publisher)->publish_status(status);
    ASSERT_TRUE((*publisher)->flush(10000));
  }
  EXPECT_EQ(heap_calls_of_this_thread() - before, 0);
  EXPECT_EQ(sending.groups, 50);
  EXPECT_EQ(sending.now - sending.at_start, 0);
  EXPECT_GT((*publisher)->counters().messages, 50 * 8);

  // The counter counts: otherwise the above says nothing.
  const std::int64_t reference = heap_calls_of_this_thread();
  const std::vector<int> some(1000);
  EXPECT_GT(heap_calls_of_this_thread(), reference);
  EXPECT_EQ(some.size(), 1000U);
}

TEST_F(LcmNetwork, WithoutARouteItWarnsGoesOnAndConnectsWhenThereIsOne) {
  ASSERT_TRUE(set_multicast_route(false));
  const SampleResult sample(1000);
  TrackMessages messages(sample.rest, kSampleModelId);
  ::testing::internal::CaptureStderr();
  auto publisher = LcmPublisher::create(kSettings, 1000);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "LCM must not print its pages";
  ASSERT_TRUE(publisher);
  EXPECT_FALSE((*publisher)->connected());
  const std::string& warning = (*publisher)->warning();
  EXPECT_NE(warning.find("ip route add 224.0.0.0/4 dev lo"), std::string::npos) << warning;
  EXPECT_EQ(warning.find('\n'), std::string::npos);
  const auto refused = LcmSubscriber::create(kSettings.url, "PLIANT");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::device);

  for (int frame = 0; frame < 100; ++frame) (*publisher)->publish(messages.encode(sample.result), frame);
  ASSERT_TRUE((*publisher)->flush(10000));
  EXPECT_EQ((*publisher)->counters().messages, 0);
  EXPECT_GT((*publisher)->counters().failures, 0);

  ASSERT_TRUE(set_multicast_route(true));
  auto subscriber = LcmSubscriber::create(kSettings.url, "PLIANT");
  ASSERT_TRUE(subscriber) << subscriber.error().message;
  EXPECT_TRUE(handle_until(**subscriber, [&] {
    (*publisher)->publish(messages.encode(sample.result), 1);
    return (*subscriber)->counters().total() > 0;
  }));
  EXPECT_TRUE((*publisher)->connected());
}

TEST_F(LcmNetwork, ANetworkThatGoesAwayIsCountedAndComesBack) {
  const SampleResult sample(1000);
  TrackMessages messages(sample.rest, kSampleModelId);
  auto subscriber = LcmSubscriber::create(kSettings.url, "PLIANT");
  ASSERT_TRUE(subscriber);
  auto publisher = LcmPublisher::create(kSettings, 1000);
  ASSERT_TRUE(publisher);
  ASSERT_TRUE(set_multicast_route(false));
  (*publisher)->publish(messages.encode(sample.result), 1);
  EXPECT_TRUE((*publisher)->flush(10000));
  EXPECT_EQ((*publisher)->counters().failures, 3);
  ASSERT_TRUE(set_multicast_route(true));
  (*publisher)->publish(messages.encode(sample.result), 2);
  EXPECT_TRUE(handle_until(**subscriber, [&] { return (*subscriber)->counters().total() == 3; }));
  EXPECT_EQ((*publisher)->counters().failures, 3);
}

TEST_F(LcmNetwork, WhatCannotReachOtherHostsIsSaidWithTheMend) {
  LcmSettings far = kSettings;
  far.url = "udpm://239.255.76.67:7667?ttl=1";
  const auto publisher = LcmPublisher::create(far, 100);
  ASSERT_TRUE(publisher);
  const std::string& warning = (*publisher)->warning();
  EXPECT_NE(warning.find("sudo ip route replace 224.0.0.0/4 dev "), std::string::npos) << warning;
  EXPECT_EQ(warning.find('\n'), std::string::npos);
  // Without any route the other advice stands.
  ASSERT_TRUE(set_multicast_route(false));
  const auto parsed = LcmUrl::parse(far.url);
  EXPECT_EQ(multicast_reach_advice(*parsed), "");
  ASSERT_TRUE(set_multicast_route(true));
}

TEST_F(LcmNetwork, ReceiveBuffersTooSmallAreSaidWithTheMend) {
  LcmSettings pictures = kSettings;
  pictures.depth_width = 1280;
  pictures.depth_height = 1024;
  const auto publisher = LcmPublisher::create(pictures, 100);
  ASSERT_TRUE(publisher);
  int room = 0;
  socklen_t size = sizeof(room);
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_EQ(::getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &room, &size), 0);
  ::close(socket);
  const std::string& warning = (*publisher)->warning();
  if (room < 2 * 1280 * 1024) {
    EXPECT_NE(warning.find("sudo sysctl -w net.core.rmem_max=8388608 net.core.rmem_default=8388608"),
              std::string::npos)
        << warning;
  } else {
    EXPECT_EQ(warning, "");
  }
  const auto url = LcmUrl::parse(kSettings.url);
  EXPECT_EQ(receive_buffer_advice(*url, 1000), "") << "room enough";
  EXPECT_NE(receive_buffer_advice(*url, std::size_t{1} << 30), "");
}

TEST_F(LcmNetwork, PicturesArriveWholeInTheReceiveBufferThatSystemsHave) {
  LcmSettings settings = kSettings;
  settings.depth_width = 640;
  settings.depth_height = 480;
  const auto publisher = LcmPublisher::create(settings, 100);
  ASSERT_TRUE(publisher);
  PictureAssembler assembler;
  int pictures = 0;
  LcmSubscriber::Handlers handlers;
  handlers.depth = [&](const DepthMessage& message) { pictures += assembler.take(message) ? 1 : 0; };
  auto subscriber = LcmSubscriber::create(settings.url, "PLIANT", handlers);
  ASSERT_TRUE(subscriber) << subscriber.error().message;
  const std::vector<std::uint16_t> pixels(640 * 480, 900);
  DepthFrame frame;
  frame.depth = pixels.data();
  frame.width = frame.stride = 640;
  frame.height = 480;
  const Intrinsics camera = {
      .width = 640, .height = 480, .fx = 500, .fy = 500, .cx = 320, .cy = 240, .depth_scale = 1000};
  constexpr int kSent = 30;
  for (int i = 0; i < kSent; ++i) {
    frame.number = frame.utime = i;
    (*publisher)->publish_depth(frame, camera);
    const auto end = std::chrono::steady_clock::now() + milliseconds(33);
    while (std::chrono::steady_clock::now() < end) (*subscriber)->handle(2);
  }
  // A busy machine may lose some all the same.
  EXPECT_TRUE(handle_until(**subscriber, [&] { return pictures >= kSent / 2; })) << pictures;
}

TEST_F(LcmNetwork, LcmLoggerRecordsWhatOurSubscriberReads) {
#ifndef PLIANT_LCM_LOGGER
  GTEST_SKIP() << "lcm-logger is not installed";
#else
  const auto log =
      std::filesystem::temp_directory_path() / ("pliant_logger_" + std::to_string(::getpid()) + ".log");
  std::string program = PLIANT_LCM_LOGGER;
  std::string url = "--lcm-url=" + kSettings.url;
  std::string path = log.string();
  std::string force = "--force", quiet = "--quiet";
  const std::vector<char*> arguments = {program.data(), force.data(), quiet.data(),
                                        url.data(),     path.data(),  nullptr};
  pid_t logger = 0;
  ASSERT_EQ(::posix_spawn(&logger, program.c_str(), nullptr, nullptr, arguments.data(), environ), 0);

  const SampleResult sample(10000);
  TrackMessages messages(sample.rest, kSampleModelId);
  auto publisher = LcmPublisher::create(kSettings, 10000);
  ASSERT_TRUE(publisher);
  // The logger writes its file after its own self test: send until there are several frames in it.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  std::error_code none;
  while (std::chrono::steady_clock::now() < end &&
         !(std::filesystem::exists(log, none) && std::filesystem::file_size(log, none) > 500'000)) {
    (*publisher)->publish(messages.encode(sample.result), 1);
    StatusContent status;
    status.version = "0.1.0";
    (*publisher)->publish_status(status);
    std::this_thread::sleep_for(milliseconds(20));
  }
  ::kill(logger, SIGINT);
  int exit_status = 0;
  ASSERT_EQ(::waitpid(logger, &exit_status, 0), logger);

  auto subscriber = LcmSubscriber::create("file://" + path + "?speed=0", "PLIANT");
  ASSERT_TRUE(subscriber) << subscriber.error().message;
  while ((*subscriber)->handle(1000) > 0) {
  }
  const auto& counters = (*subscriber)->counters();
  EXPECT_GT(counters.of(MessageKind::pose), 2);
  EXPECT_GT(counters.of(MessageKind::regions), 2);
  EXPECT_GT(counters.of(MessageKind::deformed), 2);
  EXPECT_GT(counters.of(MessageKind::status), 0);
  EXPECT_EQ(counters.garbage, 0);
  std::filesystem::remove(log);
#endif
}

}  // namespace
}  // namespace pliant
