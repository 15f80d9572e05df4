// Gives every file of the corpus, and damaged versions of it, to its fuzz target.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "drivers/lcm/messages.hpp"
#include "tests/fuzz/targets.hpp"

namespace pliant {
namespace {

std::vector<std::byte> read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::byte> bytes;
  std::transform(std::istreambuf_iterator<char>(file), {}, std::back_inserter(bytes),
                 [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

class Corpus : public ::testing::TestWithParam<FuzzTarget> {
 protected:
  [[nodiscard]] static std::vector<std::filesystem::path> files() {
    std::vector<std::filesystem::path> found;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(PLIANT_FUZZ_CORPUS) / GetParam().name))
      found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }
};

TEST_P(Corpus, EveryFileIsHandled) {
  EXPECT_GE(files().size(), 3U);
  for (const std::filesystem::path& path : files()) {
    SCOPED_TRACE(path.string());
    GetParam().run(read_bytes(path));
  }
}

TEST_P(Corpus, CutShortAndFlippedFilesAreHandled) {
  for (const std::filesystem::path& path : files()) {
    std::vector<std::byte> bytes = read_bytes(path);
    const std::size_t step = std::max<std::size_t>(1, bytes.size() / 64);
    for (std::size_t length = 0; length < bytes.size(); length += step)
      GetParam().run(std::span(bytes).first(length));
    for (std::size_t i = 0; i < bytes.size(); i += step) {
      const std::byte before = bytes[i];
      bytes[i] ^= std::byte{0x80} >> (i % 8);
      GetParam().run(bytes);
      bytes[i] = before;
    }
  }
}

/// Damage to a message of another version would be told by its first bytes alone.
TEST(MessageCorpus, HoldsMessagesOfTheTypesOfToday) {
  const auto sound = [](const char* name, auto message) {
    const auto bytes = read_bytes(std::filesystem::path(PLIANT_FUZZ_CORPUS) / "message" / name);
    std::vector<std::uint8_t> body;
    for (const std::byte byte : bytes) body.push_back(std::to_integer<std::uint8_t>(byte));
    return decode(body, message);
  };
  EXPECT_TRUE(sound("pose.bin", PoseMessage{}));
  EXPECT_TRUE(sound("regions.bin", RegionsMessage{}));
  EXPECT_TRUE(sound("regions_tracked.bin", RegionsMessage{}));
  EXPECT_TRUE(sound("deformed.bin", DeformedMessage{}));
  EXPECT_TRUE(sound("status.bin", StatusMessage{}));
  EXPECT_TRUE(sound("depth.bin", DepthMessage{}));
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, ::testing::ValuesIn(kFuzzTargets),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace pliant
