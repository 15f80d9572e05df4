// Numbers out of bytes that hold the low one first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pliant {

/// The 32 bits from `at` on, which must be there.
[[nodiscard]] inline std::uint32_t little_endian32(std::span<const unsigned char> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{bytes[at + i]} << (8 * i);
  return value;
}
[[nodiscard]] inline std::uint64_t little_endian64(std::span<const unsigned char> bytes, std::size_t at) {
  return little_endian32(bytes, at) | std::uint64_t{little_endian32(bytes, at + 4)} << 32;
}

}  // namespace pliant
