// Integer square root.
#pragma once

#include <cstdint>

namespace pliant {

/// The largest r with r * r <= x. Exact; 16 bounded steps of one bit.
[[nodiscard]] constexpr std::uint32_t integer_sqrt(std::uint32_t x) noexcept {
  std::uint32_t root = 0;
  for (std::uint32_t bit = 1U << 30; bit != 0; bit >>= 2) {
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
