// One figure for all that was said in a run: two runs that agree in it said the same, byte for byte.
#pragma once

#include <nettle/sha2.h>

#include <cstdint>
#include <span>
#include <string>

#include "drivers/lcm/track_messages.hpp"

namespace pliant {

/// SHA-256 over the bodies of pose, regions and deformed messages, one after the other in frame order. No
/// heap call but in hex().
class OutputHash {
 public:
  OutputHash() noexcept { sha256_init(&state_); }
  void add(std::span<const MessageBody> bodies) noexcept {
    for (const MessageBody& body : bodies) sha256_update(&state_, body.bytes.size(), body.bytes.data());
  }
  /// 64 hexadecimal digits; starts afresh.
  [[nodiscard]] std::string hex();

 private:
  sha256_ctx state_{};
};

}  // namespace pliant
