// Integer square root.
#pragma once

#include <bit>
#include <cstdint>

namespace pliant {

/// The largest r with r * r <= x. Exact. Of a number shifted up to its full 32 bits, by an even number of
/// them, the root grows from its first bit to 2, 4, 8 and 16 bits, each time by a step of Newton's that is
/// off by less than one (as the integer root of 64 bits in Python's math module); what a rounded root is too
/// large by goes at the end.
[[nodiscard]] constexpr std::uint32_t integer_sqrt(std::uint32_t x) noexcept {
  if (x == 0) return 0;
  const int shift = std::countl_zero(x) & ~1;
  const std::uint32_t full = x << shift;
  std::uint32_t root = 1 + (full >> 30);
  root = (root << 1) + (full >> 27) / root;
  root = (root << 3) + (full >> 21) / root;
  root = (root << 7) + (full >> 9) / root;
  root >>= shift / 2;
  return static_cast<std::uint64_t>(root) * root > x ? root - 1 : root;
}

}  // namespace pliant
