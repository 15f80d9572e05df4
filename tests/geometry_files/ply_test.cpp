#include <limits>

#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr const char* kAscii =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty uchar red\nelement face 1\nproperty list uchar int "
    "vertex_indices\nend_header\n"
    "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0.5 255\n4 0 1 2 3\n";

TEST(Ply, ReadsAsciiAndCutsPolygonsIntoFans) {
  const Geometry g = parsed(parse_ply, kAscii);
  ASSERT_EQ(g.vertices.size(), 4U);
  EXPECT_FLOAT_EQ(g.vertices[3].z, 0.5F);
  ASSERT_EQ(g.triangles.size(), 2U);
  EXPECT_EQ(g.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_TRUE(g.normals.empty());
}

/// The same square, with normals, every property of another type, an element to skip between, in either order
/// of bytes.
std::string binary(bool big) {
  std::string text =
      std::string("ply\r\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\r\nelement vertex 3\r\nproperty double z\r\nproperty list uchar short tags\r\n"
      "property short x\r\nproperty float ny\r\nproperty int8 y\r\nproperty float nx\r\n"
      "property float nz\r\nelement junk 2\r\nproperty list ushort double values\r\n"
      "element face 1\r\nproperty uchar flag\r\nproperty list int uint vertex_index\r\nend_header\r\n";
  for (int i = 0; i < 3; ++i) {
    text +=
        raw(0.25 * i, big) + raw<std::uint8_t>(2) + raw<std::int16_t>(7, big) + raw<std::int16_t>(-7, big);
    text += raw<std::int16_t>(static_cast<std::int16_t>(100 * i), big) + raw(0.0F, big);
    text += raw<std::int8_t>(static_cast<std::int8_t>(-i)) + raw(0.0F, big) + raw(1.0F, big);
  }
  text += raw<std::uint16_t>(1, big) + raw(1e9, big) + raw<std::uint16_t>(0, big);
  text += raw<std::uint8_t>(1) + raw<std::int32_t>(3, big);
  for (std::uint32_t i = 0; i < 3; ++i) text += raw(i, big);
  return text;
}

TEST(Ply, ReadsBothByteOrdersWithAnyTypesAndOrderOfProperties) {
  for (const bool big : {false, true}) {
    const Geometry g = parsed(parse_ply, binary(big));
    ASSERT_EQ(g.vertices.size(), 3U);
    EXPECT_FLOAT_EQ(g.vertices[2].x, 200);
    EXPECT_FLOAT_EQ(g.vertices[2].y, -2);
    EXPECT_FLOAT_EQ(g.vertices[2].z, 0.5F);
    ASSERT_EQ(g.normals.size(), 3U);
    EXPECT_FLOAT_EQ(g.normals[1].z, 1);
    ASSERT_EQ(g.triangles.size(), 1U);
    EXPECT_EQ(g.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  }
}

TEST(Ply, RefusesEveryCutShortFile) {
  EXPECT_EQ(accepted_beginnings(parse_ply, binary(false)), 0U);
  EXPECT_EQ(accepted_beginnings(parse_ply, std::string_view(kAscii).substr(0, std::strlen(kAscii) - 1)), 0U);
}

TEST(Ply, ReadsStrips) {
  const Geometry g =
      parsed(parse_ply,
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
             "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
             "0 0 0 1 0 0 0 1 0 1 1 0\n8 0 1 2 3 -1 0 1 2\n");
  ASSERT_EQ(g.triangles.size(), 3U);
  EXPECT_EQ(g.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(g.triangles[1], (std::array<std::uint32_t, 3>{2, 1, 3}));
  EXPECT_EQ(g.triangles[2], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(Ply, DropsAndCountsPointsThatAreNoNumbers) {
  const Geometry g =
      parsed(parse_ply,
             "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
             "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0\nnan 0 0\n1 0 0\n0 1 0\n1e99 0 0\n3 0 2 3\n3 0 1 2\n");
  EXPECT_EQ(g.vertices.size(), 3U);
  EXPECT_EQ(g.dropped, 2U);
  EXPECT_EQ(g.original_index, (std::vector<std::uint32_t>{0, 2, 3}));
  ASSERT_EQ(g.triangles.size(), 1U);
  EXPECT_EQ(g.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

std::string with_header(const std::string& lines, const std::string& data = "") {
  return "ply\n" + lines + "end_header\n" + data;
}

TEST(Ply, SaysWhatIsWrongWhereAndTheMend) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_TRUE(mentions(error_of(parse_ply, "plyx\n"), "begins with 'ply'"));
  EXPECT_TRUE(mentions(error_of(parse_ply, "ply\nformat ascii 1.0\n"), "end_header"));
  EXPECT_TRUE(mentions(error_of(parse_ply, with_header("")), "format"));
  EXPECT_TRUE(mentions(error_of(parse_ply, with_header("format odd 1.0\n")), "line 2: the format must be"));
  EXPECT_TRUE(mentions(error_of(parse_ply, with_header("format ascii 1.0\nnonsense 5\n")),
                       "line 3: unknown word 'nonsense'"));
  EXPECT_TRUE(mentions(error_of(parse_ply, with_header("format ascii 1.0\nelement vertex -1\n")), "count"));
  EXPECT_TRUE(mentions(error_of(parse_ply, with_header("format ascii 1.0\nproperty float x\n")),
                       "before any element"));
  EXPECT_TRUE(
      mentions(error_of(parse_ply, with_header("format ascii 1.0\nelement vertex 1\nproperty quad x\n")),
               "unknown type"));
  EXPECT_TRUE(mentions(
      error_of(parse_ply, with_header("format ascii 1.0\nelement vertex 1\nproperty float x\n", "1\n")),
      "no property 'y'"));
  EXPECT_TRUE(
      mentions(error_of(parse_ply, with_header("format ascii 1.0\nelement vertex 0\n" + xyz)), "no points"));
  EXPECT_TRUE(
      mentions(error_of(parse_ply, with_header("format ascii 1.0\nelement vertex 1\n" + xyz, "0 zero 0\n")),
               "line 8: 'zero' is no number"));
  EXPECT_TRUE(mentions(error_of(parse_ply, with_header("format ascii 1.0\nelement vertex 1\n" + xyz + face,
                                                       "0 0 0\n3 0 0 1\n")),
                       "vertex 1"));
  EXPECT_TRUE(mentions(error_of(parse_ply, with_header("format ascii 1.0\nelement vertex 1\n" + xyz + face,
                                                       "0 0 0\n3 0 0 -1\n")),
                       "face 0"));
  EXPECT_TRUE(mentions(
      error_of(parse_ply, with_header("format ascii 1.0\nelement vertex 1\n" + xyz + face, "0 0 0\n900 0\n")),
      "impossible list length"));
  EXPECT_TRUE(mentions(
      error_of(parse_ply, with_header("format ascii 1.0\nelement vertex 1\n" + xyz, "nan nan nan\n")),
      "finite"));
}

TEST(Ply, NeverTrustsADeclaredCount) {
  const std::string most = std::to_string(std::numeric_limits<std::int64_t>::max());
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string head = std::string("format ") + format + " 1.0\nelement vertex " + most + "\n";
    EXPECT_TRUE(mentions(error_of(parse_ply, with_header(head + xyz, "000000000000")), "room"));
  }
  // An element without properties takes no bytes, however many it says there are.
  EXPECT_TRUE(mentions(error_of(parse_ply, with_header("format ascii 1.0\nelement nothing " + most + "\n")),
                       "no points"));
}

}  // namespace
}  // namespace pliant
