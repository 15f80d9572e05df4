// Sends a tracker's messages over LCM from a thread of its own.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "drivers/common/result.hpp"
#include "drivers/lcm/depth_messages.hpp"
#include "drivers/lcm/lcm_bus.hpp"
#include "drivers/lcm/message_ring.hpp"
#include "drivers/lcm/model_messages.hpp"
#include "drivers/lcm/status_message.hpp"
#include "drivers/lcm/track_messages.hpp"

namespace pliant {

struct LcmSettings {
  std::string url;  ///< udpm://…, memq:// or file://PATH?mode=w; empty: $LCM_DEFAULT_URL, else kDefaultLcmUrl
  std::string prefix = "PLIANT";  ///< of the channels' names; 1 to 54 letters, digits, '_', '-', '.', '/'
  int depth_width = 0,
      depth_height = 0;     ///< of the pictures given to publish_depth(), pixels; 0: never called
  bool add_to_log = false;  ///< what a log file holds stays, whatever the URL's mode says
};

/// Called on the sending thread, for time and resource counts. Must not throw; may be left null.
struct SendObserver {
  void (*thread_started)(void* context) = nullptr;
  /// After the messages of one publish() were handed to the network or thrown away, with that call's utime.
  void (*group_sent)(void* context, std::int64_t utime) = nullptr;
  void (*thread_ends)(void* context) = nullptr;
  void* context = nullptr;
};

struct SendCounters {
  std::int64_t messages = 0;  ///< handed to the network, status included
  std::int64_t bytes = 0;     ///< their bodies
  std::int64_t unsent = 0;    ///< frames and pictures given up for newer ones because sending did not keep up
  std::int64_t failures = 0;  ///< messages that LCM refused, that found no network or no room in the log
};

/// publish(), publish_status() and publish_depth() are called by one thread each (or the same); they copy
/// into a slot, wake the sending thread and return: no lock, no heap call, no wait, whatever the network
/// does.
class LcmPublisher {
 public:
  /// Frames that can wait to be sent: 0.2 s at 30 Hz.
  static constexpr std::size_t kFrameSlots = 6;

  /// For models of up to `model_points` points. An error where the URL or the prefix is bad or a log file
  /// cannot be written. A network that is not there is none: warning() tells it in one line with the mend,
  /// the messages are thrown away, and the thread tries again every two seconds.
  [[nodiscard]] static Result<std::unique_ptr<LcmPublisher>> create(const LcmSettings& settings,
                                                                    std::size_t model_points,
                                                                    const SendObserver& observer = {});
  /// Whether create() could use `url`, as far as that shows without opening it: what it refuses is refused in
  /// the same words, and a network that is not there is no fault.
  [[nodiscard]] static Outcome check_url(const std::string& url);
  /// On a connection that is shared with others; needed for memq://.
  [[nodiscard]] static Result<std::unique_ptr<LcmPublisher>> create(std::shared_ptr<LcmBus> bus,
                                                                    const LcmSettings& settings,
                                                                    std::size_t model_points,
                                                                    const SendObserver& observer = {});
  /// As finish().
  ~LcmPublisher();
  LcmPublisher(const LcmPublisher&) = delete;
  LcmPublisher& operator=(const LcmPublisher&) = delete;

  /// The bodies of one frame, as TrackMessages gives them. When sending does not keep up the oldest frame
  /// waiting is given up.
  void publish(std::span<const MessageBody> bodies, std::int64_t utime) noexcept;
  void publish_status(const StatusContent& content) noexcept;
  /// For who asks for it: a picture is 0.6 MB at 640×480. Pictures wait apart from the tracker's messages and
  /// give way to newer ones likewise.
  void publish_depth(const DepthFrame& frame, const Intrinsics& camera) noexcept;

  /// From now on `model` is sent about once a second while frames are, a part after each frame. Called at
  /// most once, before the first frame; it allocates.
  void announce(const ModelView& model);

  /// Waits until everything handed over before was sent, at most `timeout_ms`; false when it was not.
  [[nodiscard]] bool flush(int timeout_ms) const noexcept;

  /// Sends what was handed over, ends the thread and a log file. Nothing may be published after.
  void finish() noexcept;
  /// What of a log file could not be written so far, first of all; after finish(): at all.
  [[nodiscard]] Outcome log_failure() const;

  /// Why subscribers may hear nothing, with the mend; empty when all is well. As of create().
  [[nodiscard]] const std::string& warning() const noexcept { return warning_; }
  [[nodiscard]] bool connected() const noexcept { return connected_.load(std::memory_order_acquire); }
  [[nodiscard]] SendCounters counters() const noexcept;
  [[nodiscard]] const LcmUrl& url() const noexcept { return url_; }

 private:
  LcmPublisher(LcmUrl url, std::shared_ptr<LcmBus> bus, const LcmSettings& settings, std::size_t model_points,
               const SendObserver& observer);
  void run() noexcept;
  void connect_again() noexcept;
  void warm_up() noexcept;
  bool send_waiting(MessageRing& ring, bool tell) noexcept;
  void wake() noexcept;
  bool send(const MessageBody& body) noexcept;
  void announce_model() noexcept;

  static constexpr std::size_t kStatusSlots = 4;
  static constexpr std::size_t kDepthSlots = 3;

  LcmUrl url_;
  std::shared_ptr<LcmBus> bus_;
  SendObserver observer_;
  std::array<std::string, kMessageKinds> channels_;
  MessageRing frames_, statuses_;
  std::unique_ptr<DepthMessages> depth_messages_;
  std::unique_ptr<MessageRing> depths_;
  std::unique_ptr<ModelMessages> model_;
  std::atomic<const ModelMessages*> announced_{nullptr};  // the same, for the sending thread
  std::size_t model_part_ = 0;  // the next to be sent; of the sending thread, as is the next
  std::chrono::steady_clock::time_point next_model_{};
  std::string warning_;
  int wake_descriptor_ = -1;
  std::atomic<bool> stop_{false}, connected_{false};
  std::atomic<std::int64_t> messages_{0}, bytes_{0}, failures_{0};
  std::atomic<std::uint64_t> handed_over_{0}, woken_for_{0};
  std::thread thread_;
};

}  // namespace pliant
