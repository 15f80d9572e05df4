#include "drivers/lcm/publisher.hpp"

#include <lcm/lcm.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <utility>

#include "drivers/lcm/lcm_log_writer.hpp"
#include "drivers/lcm/multicast_probe.hpp"

namespace pliant {

namespace {
constexpr int kRetryMs = 2000;
constexpr long kDepthPauseNs = 400'000;  // eleven parts of a VGA picture take 5 ms
constexpr std::chrono::seconds kModelEvery{1};
}  // namespace

Outcome LcmPublisher::check_url(const std::string& url) {
  const auto parsed = LcmUrl::parse(url);
  if (!parsed) return parsed.error();
  if (!parsed->writes)
    return Error{ErrorKind::bad_input, "LCM URL '" + parsed->spelled + "': add ?mode=w to write a log"};
  return parsed->writes_log() ? LcmLogWriter::check(parsed->path) : success();
}

Result<std::unique_ptr<LcmPublisher>> LcmPublisher::create(const LcmSettings& settings,
                                                           std::size_t model_points,
                                                           const SendObserver& observer) {
  if (const auto usable = check_url(settings.url); !usable) return usable.error();
  if (const auto prefix = check_channel_prefix(settings.prefix); !prefix) return prefix.error();
  auto url = LcmUrl::parse(settings.url);
  if (!url) return url.error();
  url->append = url->append || settings.add_to_log;
  std::string warning;
  std::shared_ptr<LcmBus> bus;
  auto opened = LcmBus::open(*url);
  if (opened) {
    bus = std::move(*opened);
  } else if (url->provider == LcmUrl::Provider::udp_multicast) {
    warning = opened.error().message;
  } else {
    return opened.error();
  }
  if (bus != nullptr && url->provider == LcmUrl::Provider::udp_multicast && !multicast_comes_back(*url)) {
    warning =
        multicast_advice(*url, "what is sent does not come back, subscribers on this host hear nothing");
  }
  if (bus != nullptr && warning.empty()) warning = multicast_reach_advice(*url);
  std::unique_ptr<LcmPublisher> publisher(
      new LcmPublisher(*url, std::move(bus), settings, model_points, observer));
  if (!publisher->thread_.joinable()) return Error{ErrorKind::device, "LCM: no thread can be started"};
  if (publisher->depth_messages_ != nullptr && warning.empty())
    warning = receive_buffer_advice(*url, publisher->depth_messages_->max_bytes());
  publisher->warning_ = std::move(warning);
  return publisher;
}

Result<std::unique_ptr<LcmPublisher>> LcmPublisher::create(std::shared_ptr<LcmBus> bus,
                                                           const LcmSettings& settings,
                                                           std::size_t model_points,
                                                           const SendObserver& observer) {
  const auto prefix = check_channel_prefix(settings.prefix);
  if (!prefix) return prefix.error();
  const LcmUrl url = bus->url();
  std::unique_ptr<LcmPublisher> publisher(
      new LcmPublisher(url, std::move(bus), settings, model_points, observer));
  if (!publisher->thread_.joinable()) return Error{ErrorKind::device, "LCM: no thread can be started"};
  return publisher;
}

LcmPublisher::LcmPublisher(LcmUrl url, std::shared_ptr<LcmBus> bus, const LcmSettings& settings,
                           std::size_t model_points, const SendObserver& observer)
    : url_(std::move(url)),
      bus_(std::move(bus)),
      observer_(observer),
      frames_(kFrameSlots, TrackMessages::max_bodies(model_points), TrackMessages::max_bytes(model_points)),
      statuses_(kStatusSlots, 1, kMaxStatusBytes) {
  for (int kind = 0; kind < kMessageKinds; ++kind) {
    channels_[static_cast<std::size_t>(kind)] =
        settings.prefix + std::string(channel_suffix(static_cast<MessageKind>(kind)));
  }
  if (settings.depth_width > 0 && settings.depth_height > 0) {
    depth_messages_ = std::make_unique<DepthMessages>(settings.depth_width, settings.depth_height);
    depths_ = std::make_unique<MessageRing>(kDepthSlots, depth_messages_->max_bodies(),
                                            depth_messages_->max_bytes());
  }
  connected_ = bus_ != nullptr;
  wake_descriptor_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (wake_descriptor_ < 0) return;
  if (bus_ != nullptr) warm_up();

  // Signals are for the program's other threads.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    // Left without a thread: create() reports it.
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void LcmPublisher::finish() noexcept {
  if (!thread_.joinable()) return;
  stop_.store(true, std::memory_order_release);
  wake();
  thread_.join();
  if (bus_ != nullptr) bus_->close_log();
}

Outcome LcmPublisher::log_failure() const {
  // A log's connection is there from the start; that of a network may come while this is asked.
  return url_.writes_log() ? bus_->log_failure() : success();
}

LcmPublisher::~LcmPublisher() {
  finish();
  if (wake_descriptor_ >= 0) ::close(wake_descriptor_);
}

void LcmPublisher::announce(const ModelView& model) {
  model_ = std::make_unique<ModelMessages>(model);
  announced_.store(model_.get(), std::memory_order_release);
}

void LcmPublisher::publish(std::span<const MessageBody> bodies, std::int64_t utime) noexcept {
  if (bodies.empty()) return;
  if (!frames_.push(bodies, utime)) {
    failures_.fetch_add(static_cast<std::int64_t>(bodies.size()), std::memory_order_relaxed);
    return;
  }
  wake();
}

void LcmPublisher::publish_status(const StatusContent& content) noexcept {
  std::array<std::uint8_t, kMaxStatusBytes> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  const MessageBody body = {MessageKind::status, encode_status(content, buffer)};
  if (!statuses_.push(std::span(&body, 1), content.utime)) {
    failures_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  wake();
}

void LcmPublisher::publish_depth(const DepthFrame& frame, const Intrinsics& camera) noexcept {
  // Pictures larger than announced, or never announced, are counted as failures.
  const auto bodies =
      depth_messages_ == nullptr ? std::span<const MessageBody>{} : depth_messages_->encode(frame, camera);
  if (bodies.empty() || !depths_->push(bodies, frame.utime)) {
    failures_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  wake();
}

void LcmPublisher::wake() noexcept {
  handed_over_.fetch_add(1, std::memory_order_release);
  const std::uint64_t one = 1;
  // Fails only where the counter is full, and then the thread is awake already.
  [[maybe_unused]] const ssize_t written = ::write(wake_descriptor_, &one, sizeof(one));
}

bool LcmPublisher::flush(int timeout_ms) const noexcept {
  const std::uint64_t target = handed_over_.load(std::memory_order_acquire);
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  while (woken_for_.load(std::memory_order_acquire) < target) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

SendCounters LcmPublisher::counters() const noexcept {
  return {messages_.load(std::memory_order_relaxed), bytes_.load(std::memory_order_relaxed),
          frames_.gave_way() + (depths_ != nullptr ? depths_->gave_way() : 0),
          failures_.load(std::memory_order_relaxed)};
}

void LcmPublisher::run() noexcept {
  pthread_setname_np(pthread_self(), "pliant-lcm");
  // A batch thread does not push aside who wakes it: on a busy machine the tracker ends its frame first.
  if (::sched_getscheduler(0) == SCHED_OTHER) {
    const sched_param none{};
    ::sched_setscheduler(0, SCHED_BATCH, &none);
  }
  if (observer_.thread_started != nullptr) observer_.thread_started(observer_.context);
  auto next_try = std::chrono::steady_clock::now();
  for (;;) {
    // Everything handed over before this point is in the rings and is sent below.
    const bool stopping = stop_.load(std::memory_order_acquire);
    const std::uint64_t handed_over = handed_over_.load(std::memory_order_acquire);
    bool sent = false;
    // A status waiting goes out between two frames.
    do {
      sent = send_waiting(statuses_, false);
      sent = send_waiting(frames_, true) || sent;
      sent = (depths_ != nullptr && send_waiting(*depths_, false)) || sent;
    } while (sent);
    woken_for_.store(handed_over, std::memory_order_release);
    if (stopping) {
      // A run of few frames still leaves a whole model in a log.
      while (model_part_ != 0) announce_model();
      break;
    }

    pollfd waiting{wake_descriptor_, POLLIN, 0};
    if (::poll(&waiting, 1, connected() ? -1 : kRetryMs) > 0) {
      std::uint64_t count = 0;
      [[maybe_unused]] const ssize_t got = ::read(wake_descriptor_, &count, sizeof(count));
    }
    if (!connected() && std::chrono::steady_clock::now() >= next_try) {
      connect_again();
      next_try = std::chrono::steady_clock::now() + std::chrono::milliseconds(kRetryMs);
    }
  }
  if (observer_.thread_ends != nullptr) observer_.thread_ends(observer_.context);
}

bool LcmPublisher::send_waiting(MessageRing& ring, bool tell) noexcept {
  MessageRing::Group group;
  if (!ring.take(group)) return false;
  for (const MessageBody& body : group.bodies) {
    send(body);
    // A picture at once would be a burst that small receive buffers lose.
    if (body.kind == MessageKind::depth && url_.provider == LcmUrl::Provider::udp_multicast) {
      const timespec pause{0, kDepthPauseNs};
      ::clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
    }
  }
  if (tell && observer_.group_sent != nullptr) observer_.group_sent(observer_.context, group.utime);
  ring.release();
  if (tell) announce_model();
  return true;
}

bool LcmPublisher::send(const MessageBody& body) noexcept {
  const bool sent =
      bus_ != nullptr && bus_->publish(channels_[static_cast<std::size_t>(body.kind)], body.bytes);
  if (sent) {
    messages_.fetch_add(1, std::memory_order_relaxed);
    bytes_.fetch_add(static_cast<std::int64_t>(body.bytes.size()), std::memory_order_relaxed);
  } else {
    failures_.fetch_add(1, std::memory_order_relaxed);
  }
  return sent;
}

void LcmPublisher::announce_model() noexcept {
  const ModelMessages* const model = announced_.load(std::memory_order_acquire);
  if (model == nullptr || bus_ == nullptr) return;
  // A part after each frame: a whole model at once would be a burst that small receive buffers lose.
  if (model_part_ == 0) {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_model_) return;
    next_model_ = now + kModelEvery;
  }
  send(model->bodies()[model_part_]);
  model_part_ = (model_part_ + 1) % model->bodies().size();
}

void LcmPublisher::connect_again() noexcept {
  if (multicast_route_fault(url_) != nullptr) return;
  try {
    auto opened = LcmBus::open(url_);
    if (!opened) return;
    bus_ = std::move(*opened);
  } catch (const std::bad_alloc&) {
    return;
  }
  warm_up();
  connected_.store(true, std::memory_order_release);
}

void LcmPublisher::warm_up() noexcept {
  // LCM allocates at its first transmission: one of its own self-test messages, as every LCM subscriber
  // sends.
  if (url_.provider != LcmUrl::Provider::udp_multicast) return;
  constexpr std::string_view kText = "lcm self test";
  lcm_publish(bus_->get(), "LCM_SELF_TEST", kText.data(), static_cast<unsigned int>(kText.size()));
}

}  // namespace pliant
