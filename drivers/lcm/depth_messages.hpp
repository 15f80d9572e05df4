// A depth picture as message bodies.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "drivers/lcm/track_messages.hpp"

namespace pliant {

/// Encodes into buffers that the constructor allocates and touches; encode() neither allocates nor throws.
class DepthMessages {
 public:
  /// For pictures of up to `width` × `height` pixels.
  DepthMessages(int width, int height);

  /// The bodies of one picture; none where it is larger than what was announced or empty. Valid until the
  /// next call.
  [[nodiscard]] std::span<const MessageBody> encode(const DepthFrame& frame,
                                                    const Intrinsics& camera) noexcept;

  [[nodiscard]] std::size_t max_bodies() const noexcept { return bodies_.size(); }
  [[nodiscard]] std::size_t max_bytes() const noexcept { return buffer_.size(); }

 private:
  static constexpr std::size_t kHeaderBytes = 88;  // fingerprint and fields before the readings
  /// Rows of one message.
  static constexpr int rows_per_part(int width) noexcept {
    return static_cast<int>((kMaxDepthMessageBytes - kHeaderBytes) /
                            (sizeof(std::uint16_t) * static_cast<std::size_t>(width)));
  }

  int width_, height_;
  std::vector<std::uint8_t> buffer_;
  std::vector<MessageBody> bodies_;
};

}  // namespace pliant
