#include "firmware-app/demo/listener.hpp"

namespace pliant::demo {

Result<std::unique_ptr<Listener>> Listener::create(const std::string& url, const std::string& prefix) {
  std::unique_ptr<Listener> listener(new Listener);
  LcmSubscriber::Handlers handlers;
  handlers.regions = [self = listener.get()](const RegionsMessage& message) {
    if (message.frame != self->last_frame_) ++self->frames_;
    self->last_frame_ = message.frame;
  };
  Result<std::unique_ptr<LcmSubscriber>> subscriber = LcmSubscriber::create(url, prefix, std::move(handlers));
  if (!subscriber) return subscriber.error();
  listener->subscriber_ = std::move(*subscriber);
  listener->thread_ = std::thread([self = listener.get()] { self->listen(); });
  return listener;
}

Listener::~Listener() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Listener::listen() {
  while (!stop_)
    if (subscriber_->handle(50) < 0) return;  // the end of a log
}

LcmSubscriber::Counters Listener::finish() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  while (subscriber_->handle(100) > 0) {
  }
  return subscriber_->counters();
}

}  // namespace pliant::demo
