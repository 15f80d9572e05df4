// Receives a tracker's messages over LCM, decoded and checked.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>

#include "drivers/common/result.hpp"
#include "drivers/lcm/lcm_bus.hpp"
#include "drivers/lcm/messages.hpp"

namespace pliant {

/// One thread uses it. Handlers run inside handle().
class LcmSubscriber {
 public:
  struct Handlers {
    std::function<void(const PoseMessage&)> pose;
    std::function<void(const RegionsMessage&)> regions;
    std::function<void(const DeformedMessage&)> deformed;
    std::function<void(const StatusMessage&)> status;
    std::function<void(const DepthMessage&)>
        depth;  ///< the depth channel is only subscribed to when this is set
    std::function<void(const ModelMessage&)> model;  ///< likewise
  };
  struct Counters {
    std::array<std::int64_t, kMessageKinds> decoded{};  ///< by MessageKind
    std::int64_t garbage = 0;  ///< on our channels, but not a sound message of the channel's type
    std::int64_t bytes = 0;    ///< of the bodies decoded
    [[nodiscard]] std::int64_t of(MessageKind kind) const { return decoded[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] std::int64_t total() const {
      return std::accumulate(decoded.begin(), decoded.end(), std::int64_t{0});
    }
  };

  /// `url` as LcmUrl takes it; file://LOG?speed=0 reads a log as fast as it can.
  [[nodiscard]] static Result<std::unique_ptr<LcmSubscriber>> create(std::string_view url,
                                                                     std::string_view prefix,
                                                                     Handlers handlers = {});
  [[nodiscard]] static Result<std::unique_ptr<LcmSubscriber>> create(std::shared_ptr<LcmBus> bus,
                                                                     std::string_view prefix,
                                                                     Handlers handlers = {});
  /// A URL that writes a log is refused, before the log is touched.
  [[nodiscard]] static Outcome check_readable(const LcmUrl& url);
  ~LcmSubscriber();
  LcmSubscriber(const LcmSubscriber&) = delete;
  LcmSubscriber& operator=(const LcmSubscriber&) = delete;

  /// Handles what has arrived, waiting at most `timeout_ms` for the first message. Number of LCM messages
  /// handled, -1 at the end of a log or when LCM failed.
  int handle(int timeout_ms);
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  LcmSubscriber(std::shared_ptr<LcmBus> bus, std::string_view prefix, Handlers handlers);
  bool subscribe();
  static void received(const lcm_recv_buf_t* buffer, const char* channel, void* self);
  void take(std::span<const std::uint8_t> body, std::string_view channel);
  template <typename Message>
  bool decode_and_tell(std::span<const std::uint8_t> body, Message& message,
                       const std::function<void(const Message&)>& handler);

  std::shared_ptr<LcmBus> bus_;
  std::string prefix_;
  Handlers handlers_;
  Counters counters_;
  std::array<lcm_subscription_t*, kMessageKinds> subscriptions_{};
  PoseMessage pose_;
  RegionsMessage regions_;
  DeformedMessage deformed_;
  StatusMessage status_;
  DepthMessage depth_;
  ModelMessage model_;
};

}  // namespace pliant
