// libFuzzer's entry for the target named by PLIANT_FUZZ_TARGET.
#include <cstdint>

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pliant::PLIANT_FUZZ_TARGET({static_cast<const std::byte*>(static_cast<const void*>(data)), size});
  return 0;
}
