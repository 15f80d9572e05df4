#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

TEST(Off, ReadsPlainColouredAndNormalFiles) {
  const std::string faces = "4 0 1 2 3 255 0 0\n3 0 1 2\n";
  for (const std::string& text :
       {"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 2\n" + faces,
        "# made by hand\n\nOFF 4 2 0 # counts\n0 0 0 # first\n\n1 0 0\n1 1 0\n0 1 2\n" + faces,
        "COFF\n4 2 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n1 1 0 1 0 0 1\n0 1 2 1 0 0 1\n" + faces,
        "4 2\n0 0 0\n1 0 0\n1 1 0\n0 1 2\n" + faces}) {
    const Geometry g = parsed(parse_off, text);
    ASSERT_EQ(g.vertices.size(), 4U) << text;
    EXPECT_FLOAT_EQ(g.vertices[3].z, 2);
    EXPECT_EQ(g.triangles.size(), 3U);
    EXPECT_TRUE(g.normals.empty());
  }
  const Geometry g = parsed(parse_off, "STCNOFF\n1 0 0\n0 0 0 0 0 1 255 255 255 255 0.5 0.5\n");
  ASSERT_EQ(g.normals.size(), 1U);
  EXPECT_FLOAT_EQ(g.normals[0].z, 1);
}

TEST(Off, SaysWhatIsWrongAndWhere) {
  EXPECT_TRUE(mentions(error_of(parse_off, ""), "is empty"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n"), "cut short"));
  EXPECT_TRUE(mentions(error_of(parse_off, "4OFF\n1 0 0\n"), "'4OFF'"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF BINARY\n1 0 0\n"), "binary"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\nx 1\n"), "line 2: the numbers of vertices"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n-1 1 0\n"), "line 2: the numbers of vertices"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n9223372036854775807 0 0\n0 0 0\n"), "room"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n0 9223372036854775807 0\n0 0 0\n"), "room"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n1 0 0\n0 0\n "), "line 3: a vertex needs 3 numbers"));
  EXPECT_TRUE(mentions(error_of(parse_off, "NOFF\n1 0 0\n0 0 0\n "), "6 numbers"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n2 0 0\n0 0 0\n#########\n"), "after 1 of 2 vertices"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n1 2 0\n0 0 0\n3 0 0 0\n"), "after 1 of 2 faces"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n1 1 0\n0 0 0\n3 0 0 1\n"), "names vertex 1"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n1 1 0\n0 0 0\n3 0 0 -1\n"), "names vertex -1"));
  EXPECT_TRUE(
      mentions(error_of(parse_off, "OFF\n1 1 0\n0 0 0\n999999999 0 0\n"), "names 2 of its 999999999"));
  EXPECT_TRUE(mentions(error_of(parse_off, "OFF\n0 0 0\n"), "no points"));
}

}  // namespace
}  // namespace pliant
