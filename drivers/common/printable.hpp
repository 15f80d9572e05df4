// Text from a file inside a message.
#pragma once

#include <string>
#include <string_view>

namespace pliant {

/// `text` without control characters and cut after `most` bytes, so that a message stays one short line.
inline std::string printable(std::string_view text, std::size_t most = 60) {
  std::string out;
  for (const char c : text.substr(0, most))
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return text.size() > most ? out + "..." : out;
}

}  // namespace pliant
