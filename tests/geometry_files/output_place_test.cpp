#include "drivers/geometry_files/output_place.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/temporary_folder.hpp"

namespace pliant::test {
namespace {

constexpr std::uintmax_t kMoreThanThereIs = std::numeric_limits<std::uintmax_t>::max();

std::string fault_of(const std::filesystem::path& file, std::uintmax_t room) {
  const Outcome possible = check_output_place(file.string(), room);
  return possible ? "" : possible.error().message;
}

TEST(OutputPlace, WithRoomIsFineAndStaysAsItWas) {
  const TemporaryFolder folder;
  EXPECT_EQ(fault_of(folder / "new.model", 1), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  std::ofstream(folder / "old.model") << "kept";
  EXPECT_EQ(fault_of(folder / "old.model", 1), "");
  EXPECT_EQ(std::filesystem::file_size(folder / "old.model"), 4U);
}

TEST(OutputPlace, OfADeviceNeedsNoRoom) {
  EXPECT_EQ(fault_of("/dev/null", kMoreThanThereIs), "");
}

TEST(OutputPlace, InAFolderThatIsMissingNamesIt) {
  const TemporaryFolder folder;
  const std::string fault = fault_of(folder / "missing" / "new.model", 1);
  EXPECT_NE(fault.find("there is no folder " + (folder / "missing").string() + "; make it first"),
            std::string::npos)
      << fault;
}

TEST(OutputPlace, BelowAFileIsRefusedLikeAMissingFolder) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "no folder";
  const std::string fault = fault_of(folder / "file" / "new.model", 1);
  EXPECT_NE(fault.find("there is no folder"), std::string::npos) << fault;
}

TEST(OutputPlace, WithoutRoomTellsWhatIsFreeAndWhatIsNeeded) {
  const TemporaryFolder folder;
  const std::string fault = fault_of(folder / "new.model", kMoreThanThereIs);
  EXPECT_NE(fault.find(" MB are free there and up to "), std::string::npos) << fault;
  EXPECT_NE(fault.find("free some space, or write elsewhere"), std::string::npos) << fault;
}

}  // namespace
}  // namespace pliant::test
