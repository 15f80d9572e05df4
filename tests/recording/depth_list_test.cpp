#include "drivers/recording/depth_list.hpp"

#include <gtest/gtest.h>

namespace pliant {
namespace {

Result<std::vector<DepthListEntry>> parse(std::string_view text) {
  return parse_depth_list(text, "depth.txt", "/recordings/one");
}
std::string fault(std::string_view text) {
  const auto entries = parse(text);
  if (entries) return "read";
  EXPECT_EQ(entries.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(entries.error().message.find('\n'), std::string::npos);
  return entries.error().message;
}

TEST(DepthList, ReadsStampsAndFilesInOrder) {
  const auto entries = parse(
      "# depth maps\n# timestamp filename\n"
      "1305031102.160407 depth/1305031102.160407.png\n\n"
      "  1305031102.194330\tdepth/b.png  \n");
  ASSERT_TRUE(entries) << entries.error().message;
  ASSERT_EQ(entries->size(), 2U);
  EXPECT_EQ((*entries)[0].utime, 1305031102160407);
  EXPECT_EQ((*entries)[0].file, "depth/1305031102.160407.png");
  EXPECT_EQ((*entries)[1].utime, 1305031102194330);
  EXPECT_EQ((*entries)[1].file, "depth/b.png");
}

TEST(DepthList, ToleratesCarriageReturnsAndAMissingLastNewline) {
  const auto entries = parse("0.000000 depth/000000.png\r\n\r\n0.033333 depth/000001.png");
  ASSERT_TRUE(entries) << entries.error().message;
  ASSERT_EQ(entries->size(), 2U);
  EXPECT_EQ((*entries)[1].utime, 33333);
  EXPECT_EQ((*entries)[1].file, "depth/000001.png");
}

TEST(DepthList, TakesAbsolutePathsThatLieInside) {
  const auto entries = parse("0 /recordings/one/depth/a.png\n1 ./depth/../depth/b.png\n");
  ASSERT_TRUE(entries) << entries.error().message;
  EXPECT_EQ((*entries)[0].file, "depth/a.png");
  EXPECT_EQ((*entries)[1].file, "depth/b.png");
}

TEST(DepthList, RefusesPathsThatLeadOut) {
  for (const char* path : {"../a.png", "depth/../../a.png", "/etc/passwd", "/recordings/one",
                           "/recordings/oneX/a", ".", "..", "depth/", "/"})
    EXPECT_NE(fault(std::string("0 ") + path + "\n").find("depth.txt:1: "), std::string::npos) << path;
}

TEST(DepthList, MalformedLinesAreNamed) {
  EXPECT_NE(fault("0 a.png\n0.1\n").find("depth.txt:2: a line must be"), std::string::npos);
  EXPECT_NE(fault("0 a.png extra\n").find("depth.txt:1: "), std::string::npos);
  EXPECT_NE(fault("0 a.png\n\n# c\nsoon b.png\n").find("depth.txt:4: 'soon' is not a number"),
            std::string::npos);
  EXPECT_NE(fault("1.5s b.png\n").find("not a number"), std::string::npos);
  for (const char* stamp : {"-1", "nan", "inf", "1e11"})
    EXPECT_NE(fault(std::string(stamp) + " a.png\n").find("not within"), std::string::npos) << stamp;
  EXPECT_NE(fault(std::string_view("0 a\0b\n", 6)), "read");
}

TEST(DepthList, ListingNothingIsAnError) {
  EXPECT_EQ(fault(""), "depth.txt: lists no frame");
  EXPECT_EQ(fault("# nothing\n\n"), "depth.txt: lists no frame");
}

}  // namespace
}  // namespace pliant
