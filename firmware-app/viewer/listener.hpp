// Hears a tracker and keeps a Stream up to date.
#pragma once

#include <chrono>
#include <memory>
#include <set>
#include <string>

#include "drivers/lcm/subscriber.hpp"
#include "firmware-app/viewer/packets.hpp"
#include "firmware-app/viewer/stream.hpp"

namespace pliant::viewer {

/// One thread uses it.
class Listener {
 public:
  /// `url` and `prefix` as LcmSubscriber takes them.
  Listener(std::string url, std::string prefix, Stream& stream);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Ends with an error only where the URL or the prefix can never work. A network that is not there is told
  /// to the browsers and tried again every two seconds.
  [[nodiscard]] Outcome connect();
  /// Handles what has arrived, waiting at most `timeout_ms`.
  void listen(int timeout_ms);
  [[nodiscard]] const Link& link() const { return link_; }

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] LcmSubscriber::Handlers handlers();
  void tell_link();
  void take_frame(bool whole);
  void hear_others();
  static void heard_other(const lcm_recv_buf_t* buffer, const char* channel, void* self);

  Stream& stream_;
  Link link_;
  std::set<std::string> others_;
  std::shared_ptr<LcmBus> bus_;
  std::unique_ptr<LcmSubscriber> subscriber_, capture_;  // capture_ is heard with subscriber_: one bus
  lcm_subscription_t* everybody_ = nullptr;
  FrameAssembler frames_;
  ModelAssembler models_;
  PictureAssembler depths_;
  Clock::time_point next_try_{}, next_link_{}, heard_{};
};

}  // namespace pliant::viewer
