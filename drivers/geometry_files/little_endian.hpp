// Numbers as little-endian bytes, whatever the machine.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace pliant {

inline std::byte* put_u32(std::byte* at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) *at++ = static_cast<std::byte>(value >> (8 * i) & 0xFFU);
  return at;
}
inline std::byte* put_i32(std::byte* at, std::int32_t value) {
  return put_u32(at, static_cast<std::uint32_t>(value));
}
inline std::byte* put_float(std::byte* at, float value) {
  return put_u32(at, std::bit_cast<std::uint32_t>(value));
}
inline std::byte* put_u8(std::byte* at, std::uint8_t value) {
  *at++ = static_cast<std::byte>(value);
  return at;
}

}  // namespace pliant
