// What browsers are shown: the newest of each kind, taken by each browser at its own pace.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace pliant::viewer {

/// In the order in which a browser needs them; the numbers stand in the packets.
enum class PacketKind : std::uint32_t { link = 1, status = 2, model = 3, frame = 4, depth = 5 };
inline constexpr std::size_t kPacketKinds = 5;

using Packet = std::shared_ptr<const std::vector<std::uint8_t>>;

/// One thread publishes, any number take. A packet that nobody took before the next of its kind is dropped:
/// memory and the publisher's time do not depend on who takes, or how slowly.
class Stream {
 public:
  /// What one browser has seen.
  using Seen = std::array<std::uint64_t, kPacketKinds>;

  void publish(PacketKind kind, std::vector<std::uint8_t> bytes);
  /// All packets newer than `seen`, which is brought up to date; waits up to `timeout` for a first one. Empty
  /// after that, or once the stream is closed.
  [[nodiscard]] std::vector<Packet> take_newer(Seen& seen, std::chrono::milliseconds timeout,
                                               bool with_depth);
  /// Lets everybody who waits go.
  void close();

 private:
  struct Slot {
    Packet packet;
    std::uint64_t number = 0;
  };
  std::mutex mutex_;
  std::condition_variable newer_;
  std::array<Slot, kPacketKinds> slots_;
  bool closed_ = false;
};

}  // namespace pliant::viewer
