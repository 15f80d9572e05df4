#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

const char* const kAscii =
    "solid two\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n"
    "  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 -0\n   vertex 1 1 0\n"
    "   vertex 0 1 0\n  endloop\n endfacet\nendsolid two";

/// Two triangles with an edge in common; `declared` triangles in the header.
std::string binary(std::uint32_t declared, const std::string& title = "binary") {
  std::string text = title;
  text.resize(80, ' ');
  text += raw(declared);
  const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, -0.0F, 1, 1, 0, 0, 1, 0}};
  for (const auto& triangle : corners) {
    text += raw(0.0F) + raw(0.0F) + raw(1.0F);
    for (const float c : triangle) text += raw(c);
    text += raw<std::uint16_t>(0);
  }
  return text;
}

TEST(Stl, WeldsCornersInBothEncodings) {
  for (const std::string& text : {std::string(kAscii), binary(2), binary(2, "solid but binary")}) {
    const Geometry g = parsed(parse_stl, text);
    EXPECT_EQ(g.vertices.size(), 4U);
    ASSERT_EQ(g.triangles.size(), 2U);
    EXPECT_EQ(g.triangles[1][0], g.triangles[0][1]);
  }
}

TEST(Stl, ReadsUpperCase) {
  std::string text = kAscii;
  for (char& c : text) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(parsed(parse_stl, text).triangles.size(), 2U);
}

TEST(Stl, RefusesEveryCutShortFile) {
  EXPECT_EQ(accepted_beginnings(parse_stl, binary(2)), 0U);
  EXPECT_EQ(accepted_beginnings(parse_stl, std::string_view(kAscii).substr(0, std::strlen(kAscii) - 4)), 0U);
}

TEST(Stl, SaysWhatIsWrongAndWhere) {
  EXPECT_TRUE(mentions(error_of(parse_stl, binary(3)), "3 triangles"));
  EXPECT_TRUE(mentions(error_of(parse_stl, binary(0xFFFFFFFFU)), "room for 2"));
  EXPECT_TRUE(mentions(error_of(parse_stl, binary(0)), "no points"));
  EXPECT_TRUE(mentions(error_of(parse_stl, "solid\nfacet\nvertex 0 0\n"), "line 3: a vertex needs three"));
  EXPECT_TRUE(
      mentions(error_of(parse_stl, "solid\nfacet\nvertex 0 0 0\nendfacet\nendsolid\n"), "fewer than three"));
  EXPECT_TRUE(
      mentions(error_of(parse_stl, "solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n"),
               "more than three"));
  EXPECT_TRUE(mentions(error_of(parse_stl, "solid\nfacet\nhello\n"), "line 3: unknown word 'hello'"));
}

}  // namespace
}  // namespace pliant
