// Random numbers from a counter: the same on every platform, in any order of asking.
#pragma once

#include <cstdint>

namespace pliant::simulated {

/// A well mixed 64-bit value of `x` (the finaliser of Stafford's variant 13 of MurmurHash3).
constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}
constexpr std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  return mixed(mixed(a) ^ b);
}
/// A quick 32-bit mix for one call a pixel.
constexpr std::uint32_t mixed32(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

/// Nearly Gaussian integer, mean 0, standard deviation 65536: the sum of twelve uniform 16-bit numbers.
constexpr std::int32_t gaussian(std::uint64_t a, std::uint64_t b) {
  std::int64_t sum = std::int64_t{-12} * 32768;
  for (std::uint64_t part = 0; part < 3; ++part) {
    const std::uint64_t bits = mixed(a, 3 * b + part);
    for (int shift = 0; shift < 64; shift += 16) sum += static_cast<std::int64_t>(bits >> shift & 0xffff);
  }
  return static_cast<std::int32_t>(sum);
}

}  // namespace pliant::simulated
