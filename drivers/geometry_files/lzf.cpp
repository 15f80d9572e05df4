#include "drivers/geometry_files/lzf.hpp"

#include <algorithm>
#include <cstdint>

namespace pliant {

bool lzf_unpack(std::span<const std::byte> packed, std::span<std::byte> unpacked) {
  std::size_t in = 0, out = 0;
  const auto next = [&] { return std::to_integer<std::size_t>(packed[in++]); };
  while (in < packed.size()) {
    const std::size_t control = next();
    if (control < 32) {  // control + 1 bytes as they are
      const std::size_t length = control + 1;
      if (packed.size() - in < length || unpacked.size() - out < length) return false;
      std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(in), length,
                  unpacked.begin() + static_cast<std::ptrdiff_t>(out));
      in += length;
      out += length;
      continue;
    }
    std::size_t length =
        control >> 5;  // a back reference: length (7: another byte follows), then the distance
    if (length == 7) {
      if (in == packed.size()) return false;
      length += next();
    }
    length += 2;
    if (in == packed.size()) return false;
    const std::size_t distance = ((control & 31) << 8 | next()) + 1;
    if (distance > out || unpacked.size() - out < length) return false;
    for (std::size_t i = 0; i < length; ++i, ++out) unpacked[out] = unpacked[out - distance];  // may overlap
  }
  return out == unpacked.size();
}

}  // namespace pliant
