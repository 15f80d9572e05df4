#include "firmware-app/viewer/listener.hpp"

#include <string_view>
#include <thread>
#include <utility>

#include "drivers/lcm/multicast_probe.hpp"

namespace pliant::viewer {

namespace {
constexpr std::chrono::seconds kRetry{2}, kLinkEvery{1}, kSilence{2};
constexpr std::size_t kMostOthers = 8;
}  // namespace

Listener::Listener(std::string url, std::string prefix, Stream& stream) : stream_(stream) {
  link_.url = std::move(url);
  link_.prefix = std::move(prefix);
}

Listener::~Listener() {
  if (everybody_ != nullptr) lcm_unsubscribe(bus_->get(), everybody_);
}

Outcome Listener::connect() {
  const auto url = LcmUrl::parse(link_.url);
  if (!url) return url.error();
  if (const Outcome readable = LcmSubscriber::check_readable(*url); !readable) return readable;
  link_.url = url->spelled;
  next_try_ = Clock::now() + kRetry;
  auto bus = LcmBus::open(*url);
  if (!bus) {
    link_.fault = bus.error().message;
    return bus.error().kind == ErrorKind::device ? success() : Outcome(bus.error());
  }
  // A capture shows its growing model beside the tracker's channels, on those with one more word; there are
  // none where that makes the name too long.
  std::unique_ptr<LcmSubscriber> both[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string prefix = link_.prefix + (i == 0 ? "" : kCaptureWord);
    if (i > 0 && !check_channel_prefix(prefix)) break;
    auto subscriber = LcmSubscriber::create(*bus, prefix, handlers());
    if (!subscriber) {
      link_.fault = subscriber.error().message;
      return subscriber.error().kind == ErrorKind::device ? success() : Outcome(subscriber.error());
    }
    both[i] = std::move(*subscriber);
  }
  bus_ = std::move(*bus);
  subscriber_ = std::move(both[0]);
  capture_ = std::move(both[1]);
  link_.fault.clear();
  heard_ = Clock::now();
  return success();
}

LcmSubscriber::Handlers Listener::handlers() {
  LcmSubscriber::Handlers handlers;
  handlers.regions = [this](const RegionsMessage& message) { take_frame(frames_.take(message)); };
  handlers.deformed = [this](const DeformedMessage& message) { take_frame(frames_.take(message)); };
  handlers.model = [this](const ModelMessage& message) {
    if (models_.take(message)) stream_.publish(PacketKind::model, model_packet(models_.model()));
  };
  handlers.status = [this](const StatusMessage& message) {
    stream_.publish(PacketKind::status, status_packet(message));
  };
  handlers.depth = [this](const DepthMessage& message) {
    if (depths_.take(message)) stream_.publish(PacketKind::depth, depth_packet(depths_.picture()));
  };
  return handlers;
}

void Listener::listen(int timeout_ms) {
  if (subscriber_ == nullptr) {
    std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
    // What can never work was refused at the first connect().
    if (Clock::now() >= next_try_) static_cast<void>(connect());
  } else if (subscriber_->handle(timeout_ms) < 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));  // the end of a log
  }
  if (Clock::now() < next_link_) return;
  next_link_ = Clock::now() + kLinkEvery;
  hear_others();
  tell_link();
}

void Listener::take_frame(bool whole) {
  heard_ = Clock::now();
  if (whole) stream_.publish(PacketKind::frame, frame_packet(frames_.frame()));
}

void Listener::tell_link() {
  link_.others.assign(others_.begin(), others_.end());
  constexpr std::size_t kPictureBytes = 2 * 640 * 480;
  const std::int64_t incomplete = frames_.incomplete() + depths_.incomplete();
  const auto url = LcmUrl::parse(link_.url);
  if (incomplete > link_.incomplete && url) link_.advice = receive_buffer_advice(*url, kPictureBytes);
  link_.incomplete = incomplete;
  stream_.publish(PacketKind::link, link_packet(link_));
}

void Listener::hear_others() {
  if (bus_ == nullptr) return;
  const bool silent = Clock::now() - heard_ > kSilence;
  if (silent && everybody_ == nullptr) {
    everybody_ = lcm_subscribe(bus_->get(), ".*_REGIONS", &Listener::heard_other, this);
  } else if (!silent && everybody_ != nullptr) {
    lcm_unsubscribe(bus_->get(), everybody_);
    everybody_ = nullptr;
    others_.clear();
  }
}

void Listener::heard_other(const lcm_recv_buf_t* /*buffer*/, const char* channel, void* self) {
  auto& listener = *static_cast<Listener*>(self);
  const std::string_view name = channel;
  const std::string_view prefix = name.substr(0, name.size() - std::string_view("_REGIONS").size());
  if (prefix != listener.link_.prefix && check_channel_prefix(prefix) &&
      listener.others_.size() < kMostOthers)
    listener.others_.emplace(prefix);
}

}  // namespace pliant::viewer
