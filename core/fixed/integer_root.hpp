// Integer square root.
#pragma once

#include <bit>
#include <cstdint>

namespace pliant {

/// The largest r with r * r <= x. Exact; a bounded step for each of its bits, 16 at most.
[[nodiscard]] constexpr std::uint32_t integer_sqrt(std::uint32_t x) noexcept {
  std::uint32_t root = 0;
  for (std::uint32_t bit = x == 0 ? 0 : 1U << ((31 - std::countl_zero(x)) & ~1); bit != 0; bit >>= 2) {
    if (x >= root + bit) {
      x -= root + bit;
      root = (root >> 1) + bit;
    } else {
      root >>= 1;
    }
  }
  return root;
}

}  // namespace pliant
