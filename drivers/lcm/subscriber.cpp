#include "drivers/lcm/subscriber.hpp"

#include <poll.h>

#include <utility>

#include "drivers/lcm/multicast_probe.hpp"

namespace pliant {

namespace {
// Messages that LCM keeps for us between two calls of handle(): two seconds of a frame's parts at 30 Hz.
constexpr int kQueueCapacity = 1000;
// What one call of handle() works off, so that a flooded bus cannot hold it for ever.
constexpr int kMostPerCall = 1000;
}  // namespace

Outcome LcmSubscriber::check_readable(const LcmUrl& url) {
  if (!url.writes_log()) return success();
  return Error{ErrorKind::bad_input,
               "LCM URL '" + url.spelled + "' would write to the log; use ?mode=r to read it"};
}

Result<std::unique_ptr<LcmSubscriber>> LcmSubscriber::create(std::string_view url, std::string_view prefix,
                                                             Handlers handlers) {
  const auto parsed = LcmUrl::parse(url);
  if (!parsed) return parsed.error();
  if (const auto readable = check_readable(*parsed); !readable) return readable.error();
  auto bus = LcmBus::open(*parsed);
  if (!bus) return bus.error();
  return create(std::move(*bus), prefix, std::move(handlers));
}

Result<std::unique_ptr<LcmSubscriber>> LcmSubscriber::create(std::shared_ptr<LcmBus> bus,
                                                             std::string_view prefix, Handlers handlers) {
  const auto checked = check_channel_prefix(prefix);
  if (!checked) return checked.error();
  const LcmUrl& url = bus->url();
  if (const auto readable = check_readable(url); !readable) return readable.error();
  // LCM would test the same for ten seconds.
  if (url.provider == LcmUrl::Provider::udp_multicast && !multicast_comes_back(url)) {
    return Error{ErrorKind::device, multicast_advice(url, "what is sent does not come back to this host")};
  }
  std::unique_ptr<LcmSubscriber> subscriber(new LcmSubscriber(std::move(bus), prefix, std::move(handlers)));
  if (!subscriber->subscribe()) {
    return Error{ErrorKind::device, "LCM at " + subscriber->bus_->url().spelled + ": cannot subscribe"};
  }
  return subscriber;
}

LcmSubscriber::LcmSubscriber(std::shared_ptr<LcmBus> bus, std::string_view prefix, Handlers handlers)
    : bus_(std::move(bus)), prefix_(prefix), handlers_(std::move(handlers)) {}

LcmSubscriber::~LcmSubscriber() {
  for (lcm_subscription_t* const subscription : subscriptions_) {
    if (subscription != nullptr) lcm_unsubscribe(bus_->get(), subscription);
  }
}

bool LcmSubscriber::subscribe() {
  for (int kind = 0; kind < kMessageKinds; ++kind) {
    if (static_cast<MessageKind>(kind) == MessageKind::depth && !handlers_.depth) continue;
    if (static_cast<MessageKind>(kind) == MessageKind::model && !handlers_.model) continue;
    std::string pattern;
    // LCM takes a regular expression; '.' is the only allowed character that means something else there.
    for (const char c : prefix_) pattern += c == '.' ? std::string("\\.") : std::string(1, c);
    pattern += channel_suffix(static_cast<MessageKind>(kind));
    auto& subscription = subscriptions_[static_cast<std::size_t>(kind)];
    subscription = lcm_subscribe(bus_->get(), pattern.c_str(), &LcmSubscriber::received, this);
    if (subscription == nullptr) return false;
    lcm_subscription_set_queue_capacity(subscription, kQueueCapacity);
  }
  return true;
}

int LcmSubscriber::handle(int timeout_ms) {
  int handled = 0;
  while (handled < kMostPerCall) {
    // Not lcm_handle_timeout(): its select() takes no descriptor above 1023.
    pollfd waiting{lcm_get_fileno(bus_->get()), POLLIN, 0};
    if (::poll(&waiting, 1, handled == 0 ? timeout_ms : 0) <= 0) break;
    if (lcm_handle(bus_->get()) != 0) return handled == 0 ? -1 : handled;
    ++handled;
  }
  return handled;
}

void LcmSubscriber::received(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
  static_cast<LcmSubscriber*>(self)->take({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size},
                                          channel);
}

template <typename Message>
bool LcmSubscriber::decode_and_tell(std::span<const std::uint8_t> body, Message& message,
                                    const std::function<void(const Message&)>& handler) {
  if (!decode(body, message)) return false;
  if (handler) handler(message);
  return true;
}

void LcmSubscriber::take(std::span<const std::uint8_t> body, std::string_view channel) {
  const std::string_view suffix = channel.substr(std::min(prefix_.size(), channel.size()));
  bool sound = false;
  MessageKind kind = MessageKind::pose;
  if (suffix == channel_suffix(MessageKind::pose)) {
    sound = decode_and_tell(body, pose_, handlers_.pose);
  } else if (suffix == channel_suffix(MessageKind::regions)) {
    kind = MessageKind::regions;
    sound = decode_and_tell(body, regions_, handlers_.regions);
  } else if (suffix == channel_suffix(MessageKind::deformed)) {
    kind = MessageKind::deformed;
    sound = decode_and_tell(body, deformed_, handlers_.deformed);
  } else if (suffix == channel_suffix(MessageKind::status)) {
    kind = MessageKind::status;
    sound = decode_and_tell(body, status_, handlers_.status);
  } else if (suffix == channel_suffix(MessageKind::depth)) {
    kind = MessageKind::depth;
    sound = decode_and_tell(body, depth_, handlers_.depth);
  } else if (suffix == channel_suffix(MessageKind::model)) {
    kind = MessageKind::model;
    sound = decode_and_tell(body, model_, handlers_.model);
  }
  if (!sound) {
    ++counters_.garbage;
    return;
  }
  ++counters_.decoded[static_cast<std::size_t>(kind)];
  counters_.bytes += static_cast<std::int64_t>(body.size());
}

}  // namespace pliant
