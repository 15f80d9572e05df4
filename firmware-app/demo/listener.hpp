// A subscriber on a thread of its own that counts what arrives and decodes.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "drivers/lcm/subscriber.hpp"

namespace pliant::demo {

class Listener {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Listener>> create(const std::string& url,
                                                                const std::string& prefix);
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  ~Listener();

  /// Takes what is still under way, ends the thread and tells the counts.
  [[nodiscard]] LcmSubscriber::Counters finish();
  /// Frames whose regions arrived, seen in the messages themselves.
  [[nodiscard]] std::int64_t frames() const { return frames_; }

 private:
  Listener() = default;
  void listen();

  std::unique_ptr<LcmSubscriber> subscriber_;
  std::atomic<bool> stop_{false};
  std::int64_t frames_ = 0, last_frame_ = -1;
  std::thread thread_;
};

}  // namespace pliant::demo
