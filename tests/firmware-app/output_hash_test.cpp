#include "firmware-app/outputs/output_hash.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace pliant {
namespace {

MessageBody body(const char* text) {
  return {MessageKind::pose,
          {static_cast<const std::uint8_t*>(static_cast<const void*>(text)), std::strlen(text)}};
}

TEST(OutputHash, IsSha256OfTheBodiesInOrder) {
  OutputHash hash;
  EXPECT_EQ(hash.hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  const MessageBody bodies[] = {body("a"), body("bc")};
  hash.add(bodies);
  EXPECT_EQ(hash.hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");  // of "abc"
}

}  // namespace
}  // namespace pliant
