#include "firmware-app/viewer/stream.hpp"

#include <utility>

namespace pliant::viewer {

void Stream::publish(PacketKind kind, std::vector<std::uint8_t> bytes) {
  auto packet = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[static_cast<std::size_t>(kind) - 1];
    slot.packet.swap(packet);
    ++slot.number;
  }
  // The packet before is freed here, outside the lock.
  newer_.notify_all();
}

std::vector<Packet> Stream::take_newer(Seen& seen, std::chrono::milliseconds timeout, bool with_depth) {
  const auto wanted = [&](std::size_t kind) {
    return slots_[kind].number > seen[kind] &&
           (with_depth || kind + 1 != static_cast<std::size_t>(PacketKind::depth));
  };
  const auto any = [&] {
    for (std::size_t kind = 0; kind < kPacketKinds; ++kind)
      if (wanted(kind)) return true;
    return closed_;
  };
  std::vector<Packet> packets;
  std::unique_lock lock(mutex_);
  newer_.wait_for(lock, timeout, any);
  if (closed_) return packets;
  for (std::size_t kind = 0; kind < kPacketKinds; ++kind) {
    if (!wanted(kind)) continue;
    packets.push_back(slots_[kind].packet);
    seen[kind] = slots_[kind].number;
  }
  return packets;
}

void Stream::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  newer_.notify_all();
}

}  // namespace pliant::viewer
