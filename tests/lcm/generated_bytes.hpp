// What the classes that lcm-gen makes of the types write.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace pliant {

template <typename Message>
std::vector<std::uint8_t> generated_bytes(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace pliant
