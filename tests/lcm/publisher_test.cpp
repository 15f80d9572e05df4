// The publisher inside one process (memq://), into log files, and its bad input.
#include "drivers/lcm/publisher.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "drivers/lcm/lcm_log.hpp"
#include "drivers/lcm/subscriber.hpp"
#include "tests/lcm/sample_result.hpp"

namespace pliant {
namespace {

std::shared_ptr<LcmBus> memory_bus() {
  auto bus = LcmBus::open("memq://");
  EXPECT_TRUE(bus);
  return *bus;
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("pliant_lcm_" + std::to_string(::getpid()) + "_" + name)) {}
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(LcmPublisher, BringsEveryMessageToASubscriber) {
  const SampleResult sample(16384, 2);
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto bus = memory_bus();
  std::int64_t labels = 0, deformed = 0;
  LcmSubscriber::Handlers handlers;
  handlers.regions = [&](const RegionsMessage& message) { labels += std::ssize(message.labels); };
  handlers.deformed = [&](const DeformedMessage& message) { deformed += std::ssize(message.index); };
  auto subscriber = LcmSubscriber::create(bus, "TEST", handlers);
  ASSERT_TRUE(subscriber);
  auto publisher = LcmPublisher::create(bus, {.url = "memq://", .prefix = "TEST"}, sample.rest.size());
  ASSERT_TRUE(publisher);
  EXPECT_EQ((*publisher)->warning(), "");

  const auto bodies = messages.encode(sample.result);
  (*publisher)->publish(bodies, sample.result.utime);
  StatusContent status;
  status.version = "0.1.0";
  (*publisher)->publish_status(status);
  ASSERT_TRUE((*publisher)->flush(10000));
  (*subscriber)->handle(1000);

  const auto& counters = (*subscriber)->counters();
  EXPECT_EQ(counters.total(), std::ssize(bodies) + 1);
  EXPECT_EQ(counters.of(MessageKind::pose), 1);
  EXPECT_EQ(counters.of(MessageKind::regions), 2);
  EXPECT_EQ(counters.of(MessageKind::deformed), 16);
  EXPECT_EQ(counters.of(MessageKind::status), 1);
  EXPECT_EQ(counters.garbage, 0);
  EXPECT_EQ(labels, 16384);
  EXPECT_EQ(deformed, 8192);
  const SendCounters sent = (*publisher)->counters();
  EXPECT_EQ(sent.messages, counters.total());
  EXPECT_EQ(sent.bytes, counters.bytes);
  EXPECT_EQ(sent.failures, 0);
}

TEST(LcmPublisher, SeveralTrackersShareABus) {
  const SampleResult sample(100);
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto bus = memory_bus();
  auto left = LcmSubscriber::create(bus, "A.left");
  auto right = LcmSubscriber::create(bus, "A_left");
  ASSERT_TRUE(left);
  ASSERT_TRUE(right);
  auto publisher = LcmPublisher::create(bus, {.url = {}, .prefix = "A.left"}, 100);
  ASSERT_TRUE(publisher);
  (*publisher)->publish(messages.encode(sample.result), 1);
  ASSERT_TRUE((*publisher)->flush(10000));
  (*left)->handle(1000);
  EXPECT_EQ((*left)->counters().total(), 3);
  EXPECT_EQ((*right)->counters().total() + (*right)->counters().garbage, 0);
}

TEST(LcmPublisher, WhenSendingDoesNotKeepUpTheNewestWins) {
  // Sending stands still in the observer until the gate opens.
  struct Gate {
    std::atomic<bool> open{false}, reached{false};
  } gate;
  SendObserver observer;
  observer.context = &gate;
  observer.group_sent = [](void* context, std::int64_t) {
    auto& it = *static_cast<Gate*>(context);
    it.reached = true;
    it.reached.notify_all();
    it.open.wait(false);
  };
  const auto bus = memory_bus();
  std::vector<std::int64_t> stamps;
  LcmSubscriber::Handlers handlers;
  handlers.pose = [&](const PoseMessage& message) { stamps.push_back(message.utime); };
  auto subscriber = LcmSubscriber::create(bus, "PLIANT", handlers);
  ASSERT_TRUE(subscriber);
  auto publisher = LcmPublisher::create(bus, {}, 100, observer);
  ASSERT_TRUE(publisher);
  SampleResult sample(100);
  TrackMessages messages(sample.rest, kSampleModelId);
  constexpr std::int64_t kFrames = 100;
  for (std::int64_t frame = 1; frame <= kFrames; ++frame) {
    sample.result.utime = frame;
    (*publisher)->publish(messages.encode(sample.result), frame);
    if (frame == 1) gate.reached.wait(false);
  }
  EXPECT_FALSE((*publisher)->flush(1));
  const std::int64_t unsent = (*publisher)->counters().unsent;
  gate.open = true;
  gate.open.notify_all();
  ASSERT_TRUE((*publisher)->flush(10000));
  (*subscriber)->handle(1000);
  ASSERT_EQ(std::ssize(stamps), kFrames - unsent);
  EXPECT_EQ(stamps.front(), 1);
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    EXPECT_EQ(stamps[k], kFrames - std::ssize(stamps) + 1 + static_cast<std::int64_t>(k))
        << "the newest, in order";
  }
  EXPECT_GT(unsent, 80);
  EXPECT_LT(unsent, kFrames - 1);
}

TEST(LcmPublisher, EndsOnlyWhenAllIsSent) {
  const TemporaryFile log("end.log");
  const SampleResult sample(10000);
  TrackMessages messages(sample.rest, kSampleModelId);
  std::int64_t bodies = 0;
  {
    auto publisher =
        LcmPublisher::create({.url = "file://" + log.path() + "?mode=w", .prefix = "PLIANT"}, 10000);
    ASSERT_TRUE(publisher);
    for (int frame = 0; frame < 4; ++frame) {
      const auto frame_bodies = messages.encode(sample.result);
      bodies += std::ssize(frame_bodies);
      (*publisher)->publish(frame_bodies, frame);
    }
  }
  auto subscriber = LcmSubscriber::create("file://" + log.path() + "?speed=0", "PLIANT");
  ASSERT_TRUE(subscriber);
  while ((*subscriber)->handle(1000) > 0) {
  }
  EXPECT_EQ((*subscriber)->counters().total(), bodies);
  EXPECT_EQ((*subscriber)->counters().garbage, 0);
}

TEST(LcmPublisher, AWrittenLogIsALog) {
  const TemporaryFile file("written.log");
  std::ofstream(file.path()) << "what was there";
  const std::string body(100'000, 'b');
  const auto bytes = [](const std::string& text) {
    return std::span(static_cast<const std::uint8_t*>(static_cast<const void*>(text.data())), text.size());
  };
  for (const char* mode : {"w", "a"}) {
    const auto bus = LcmBus::open("file://" + file.path() + "?mode=" + mode);
    ASSERT_TRUE(bus) << bus.error().message;
    EXPECT_TRUE((*bus)->publish("EMPTY", {}));
    EXPECT_TRUE((*bus)->publish("BODY", bytes(body)));
    (*bus)->close_log();
    EXPECT_TRUE((*bus)->log_failure());
  }
  // As LCM itself reads it.
  lcm_eventlog_t* const log = lcm_eventlog_create(file.path().c_str(), "r");
  ASSERT_NE(log, nullptr);
  for (int run = 0; run < 2; ++run) {
    for (std::int64_t number = 0; number < 2; ++number) {
      lcm_eventlog_event_t* const event = lcm_eventlog_read_next_event(log);
      ASSERT_NE(event, nullptr);
      EXPECT_EQ(event->eventnum, number);
      EXPECT_GT(event->timestamp, 1'600'000'000'000'000);
      EXPECT_EQ(std::string(event->channel), number == 0 ? "EMPTY" : "BODY");
      EXPECT_EQ(event->datalen, number == 0 ? 0 : std::ssize(body));
      lcm_eventlog_free_event(event);
    }
  }
  EXPECT_EQ(lcm_eventlog_read_next_event(log), nullptr);
  lcm_eventlog_destroy(log);
}

TEST(LcmPublisher, AFullDiskIsToldAndTheLogEndsWithAWholeMessage) {
  const SampleResult sample(1000);
  TrackMessages messages(sample.rest, kSampleModelId);
  {
    const auto publisher = LcmPublisher::create({.url = "file:///dev/full?mode=w", .prefix = "PLIANT"}, 1000);
    ASSERT_TRUE(publisher) << publisher.error().message;
    (*publisher)->publish(messages.encode(sample.result), 1);
    (*publisher)->finish();
    const Outcome failure = (*publisher)->log_failure();
    ASSERT_FALSE(failure);
    EXPECT_EQ(failure.error().kind, ErrorKind::write);
    EXPECT_NE(failure.error().message.find("/dev/full"), std::string::npos) << failure.error().message;
    EXPECT_NE(failure.error().message.find("; free some space"), std::string::npos);
    EXPECT_EQ((*publisher)->counters().messages, 0);
    EXPECT_GT((*publisher)->counters().failures, 0);
  }
  // A limit of the file's size cuts a write off in its middle, as a full disk does.
  const TemporaryFile file("limited.log");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const auto publisher =
      LcmPublisher::create({.url = "file://" + file.path() + "?mode=w", .prefix = "PLIANT"}, 1000);
  ASSERT_TRUE(publisher) << publisher.error().message;
  const rlimit little{10'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);
  for (int frame = 0; frame < 10; ++frame) {
    (*publisher)->publish(messages.encode(sample.result), frame);
    EXPECT_TRUE((*publisher)->flush(10000));
  }
  setrlimit(RLIMIT_FSIZE, &before);
  (*publisher)->publish(messages.encode(sample.result), 10);  // there is room again
  (*publisher)->finish();
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE((*publisher)->log_failure());
  const SendCounters sent = (*publisher)->counters();
  EXPECT_GT(sent.failures, 0);
  auto log = LcmLog::open(file.path());
  ASSERT_TRUE(log) << log.error().message;
  LcmLogEvent event;
  std::int64_t events = 0;
  for (; log->next(event); ++events) EXPECT_EQ(event.number, events);
  EXPECT_EQ(events, sent.messages);
  EXPECT_EQ(log->damages(), 0);
}

TEST(LcmPublisher, CheckOpensNothing) {
  const TemporaryFile file("checked.log");
  std::ofstream(file.path()) << "what was there";
  EXPECT_TRUE(LcmPublisher::check_url("file://" + file.path() + "?mode=w"));
  EXPECT_EQ(std::filesystem::file_size(file.path()), 14U);
  const TemporaryFile none("none");
  EXPECT_TRUE(LcmPublisher::check_url("file://" + none.path() + "?mode=w"));
  EXPECT_FALSE(std::filesystem::exists(none.path()));
  for (const std::string& path :
       {none.path() + "/x.log", std::filesystem::temp_directory_path().string(), file.path() + "/x"}) {
    const Outcome checked = LcmPublisher::check_url("file://" + path + "?mode=w");
    ASSERT_FALSE(checked) << path;
    EXPECT_EQ(checked.error().kind, ErrorKind::write);
  }
}

TEST(LcmPublisher, BadInputIsOneLine) {
  for (const LcmSettings& settings :
       {LcmSettings{.url = "nonsense", .prefix = "PLIANT"}, LcmSettings{.url = "tcpq://", .prefix = "PLIANT"},
        LcmSettings{.url = "memq://", .prefix = "A B"},
        LcmSettings{.url = "file://x.log", .prefix = "PLIANT"}}) {
    const auto publisher = LcmPublisher::create(settings, 100);
    ASSERT_FALSE(publisher) << settings.url;
    EXPECT_EQ(publisher.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(publisher.error().message.find('\n'), std::string::npos);
  }
  const auto unwritable =
      LcmPublisher::create({.url = "file:///no/such/folder/x.log?mode=w", .prefix = "PLIANT"}, 100);
  ASSERT_FALSE(unwritable);
  EXPECT_EQ(unwritable.error().kind, ErrorKind::write);
}

TEST(LcmPublisher, MoreThanItWasMadeForIsCountedNotSent) {
  const SampleResult sample(10000, 1);
  TrackMessages messages(sample.rest, kSampleModelId);
  const auto bus = memory_bus();
  auto publisher = LcmPublisher::create(bus, {}, 100);
  ASSERT_TRUE(publisher);
  (*publisher)->publish(messages.encode(sample.result), 1);
  ASSERT_TRUE((*publisher)->flush(10000));
  EXPECT_EQ((*publisher)->counters().messages, 0);
  EXPECT_GT((*publisher)->counters().failures, 0);
}

TEST(LcmSubscriber, CountsGarbageOnItsChannels) {
  const auto bus = memory_bus();
  auto subscriber = LcmSubscriber::create(bus, "PLIANT");
  ASSERT_TRUE(subscriber);
  const std::string text = "this is no message";
  for (const char* channel :
       {"PLIANT_POSE", "PLIANT_REGIONS", "PLIANT_DEFORMED", "PLIANT_STATUS", "PLIANT_OTHER"}) {
    ASSERT_EQ(lcm_publish(bus->get(), channel, text.data(), static_cast<unsigned int>(text.size())), 0);
  }
  ASSERT_EQ(lcm_publish(bus->get(), "PLIANT_POSE", text.data(), 0), 0);
  (*subscriber)->handle(1000);
  EXPECT_EQ((*subscriber)->counters().garbage, 5);
  EXPECT_EQ((*subscriber)->counters().total(), 0);
}

TEST(LcmSubscriber, LeavesALogAloneThatItsUrlWouldWrite) {
  const TemporaryFile file("kept.log");
  std::ofstream(file.path()) << "what was there";
  for (const char* mode : {"w", "a"}) {
    const auto subscriber = LcmSubscriber::create("file://" + file.path() + "?mode=" + mode, "PLIANT");
    ASSERT_FALSE(subscriber);
    EXPECT_EQ(subscriber.error().kind, ErrorKind::bad_input);
    EXPECT_NE(subscriber.error().message.find("?mode=r"), std::string::npos) << subscriber.error().message;
  }
  EXPECT_EQ(std::filesystem::file_size(file.path()), 14U);
}

TEST(LcmSubscriber, RefusesWhatIsNoLog) {
  EXPECT_FALSE(LcmSubscriber::create("file:///no/such.log", "PLIANT"));
  const TemporaryFile file("none.log");
  std::ofstream(file.path()) << "text";
  const auto subscriber = LcmSubscriber::create("file://" + file.path(), "PLIANT");
  ASSERT_FALSE(subscriber);
  EXPECT_EQ(subscriber.error().kind, ErrorKind::bad_input);
}

}  // namespace
}  // namespace pliant
