#include "drivers/geometry_files/atomic_file.hpp"

#include <sys/stat.h>

#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

TEST(AtomicFile, TheNameStandsOnlyForTheWhole) {
  const TemporaryFolder folder;
  const std::string path = (folder / "out").string();
  {
    AtomicFile file;
    ASSERT_TRUE(file.open(path.c_str()));
    ASSERT_TRUE(file.write(bytes_of("half")));
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  EXPECT_EQ(folder.count(), 0U);
  ASSERT_TRUE(write_whole_file(path.c_str(), bytes_of("first"), true));
  AtomicFile file;
  ASSERT_TRUE(file.open(path.c_str()));
  ASSERT_TRUE(file.write(bytes_of("sec")));
  EXPECT_EQ(contents(path), "first");
  ASSERT_TRUE(file.write(bytes_of("ond")));
  ASSERT_TRUE(file.commit(false));
  EXPECT_EQ(contents(path), "second");
  EXPECT_EQ(folder.count(), 1U);
}

TEST(AtomicFile, KeepsALinkAndWritesItsTarget) {
  const TemporaryFolder folder;
  put(folder / "target", "old");
  std::filesystem::create_symlink(folder / "target", folder / "link");
  ASSERT_TRUE(write_whole_file((folder / "link").c_str(), bytes_of("new"), false));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(contents(folder / "target"), "new");
}

TEST(AtomicFile, FailuresAreWriteErrorsWithTheMend) {
  const TemporaryFolder folder;
  const auto error = [](const std::string& path) {
    const Outcome written = write_whole_file(path.c_str(), bytes_of("data"), false);
    EXPECT_FALSE(written);
    if (written) return std::string();
    EXPECT_EQ(written.error().kind, ErrorKind::write);
    return written.error().message;
  };
  EXPECT_TRUE(mentions(error((folder / "none" / "out").string()), "make the folder first"));
  EXPECT_TRUE(mentions(error(folder.path().string()), "name a file"));
  EXPECT_TRUE(mentions(error(std::string(5000, 'x')), "too long"));
  if (std::filesystem::is_character_file("/dev/full")) {
    EXPECT_TRUE(mentions(error("/dev/full"), "/dev/full"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));  // a device is written to, not replaced
  }
  EXPECT_EQ(folder.count(), 0U);
}

}  // namespace
}  // namespace pliant
