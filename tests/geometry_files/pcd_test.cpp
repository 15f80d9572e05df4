#include <limits>

#include "drivers/geometry_files/lzf.hpp"
#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

std::string header(const std::string& data, const std::string& counts = "WIDTH 3\nHEIGHT 1\nPOINTS 3\n") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x rgb y _ z\nSIZE 4 4 8 1 4\n"
         "TYPE F U F U F\nCOUNT 1 1 1 3 1\n" +
         counts + "VIEWPOINT 0 0 0 1 0 0 0\nDATA " + data + "\n";
}

/// Point i is (i, 10 i, 100 i).
std::string point(int i) {
  return raw(static_cast<float>(i)) + raw<std::uint32_t>(0xFF00FF) + raw(10.0 * i) + "abc" +
         raw(static_cast<float>(100 * i));
}

void expect_three_points(const Geometry& g) {
  ASSERT_EQ(g.vertices.size(), 3U);
  EXPECT_FLOAT_EQ(g.vertices[2].x, 2);
  EXPECT_FLOAT_EQ(g.vertices[2].y, 20);
  EXPECT_FLOAT_EQ(g.vertices[2].z, 200);
}

/// Packs without finding anything to shorten.
std::string lzf_stored(std::string_view plain) {
  std::string packed;
  for (std::size_t i = 0; i < plain.size(); i += 32) {
    const std::string_view run = plain.substr(i, 32);
    packed += static_cast<char>(run.size() - 1);
    packed += run;
  }
  return packed;
}

std::string compressed() {
  std::string plain;
  for (int i = 0; i < 3; ++i) plain += raw(static_cast<float>(i));
  for (int i = 0; i < 3; ++i) plain += raw<std::uint32_t>(1);
  for (int i = 0; i < 3; ++i) plain += raw(10.0 * i);
  plain += "abcabcabc";
  for (int i = 0; i < 3; ++i) plain += raw(static_cast<float>(100 * i));
  const std::string packed = lzf_stored(plain);
  return header("binary_compressed") + raw(static_cast<std::uint32_t>(packed.size())) +
         raw(static_cast<std::uint32_t>(plain.size())) + packed;
}

TEST(Pcd, ReadsAllThreeEncodings) {
  expect_three_points(parsed(
      parse_pcd, header("ascii") + "0 7 0 1 2 3 0\n# a comment\n1 7 10 1 2 3 100\n\n2 7 20 1 2 3 200"));
  expect_three_points(parsed(parse_pcd, header("binary") + point(0) + point(1) + point(2)));
  expect_three_points(parsed(parse_pcd, compressed()));
}

TEST(Pcd, DropsHolesOfOrganisedCloudsAndKeepsTheNumbersOfTheRest) {
  const Geometry g = parsed(parse_pcd,
                            "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n"
                            "nan nan nan\n1 1 1\n2 2 -inf\n3 3 3\n");
  EXPECT_EQ(g.dropped, 2U);
  EXPECT_EQ(g.original_index, (std::vector<std::uint32_t>{1, 3}));
  EXPECT_FLOAT_EQ(g.vertices[1].x, 3);
}

TEST(Pcd, ReadsNormals) {
  const Geometry g =
      parsed(parse_pcd,
             "FIELDS x y z normal_x normal_y normal_z curvature\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\n"
             "POINTS 1\nDATA ascii\n1 2 3 0 0 1 0.1\n");
  ASSERT_EQ(g.normals.size(), 1U);
  EXPECT_FLOAT_EQ(g.normals[0].z, 1);
}

TEST(Pcd, RefusesEveryCutShortFile) {
  EXPECT_EQ(accepted_beginnings(parse_pcd, header("binary") + point(0) + point(1) + point(2)), 0U);
  EXPECT_EQ(accepted_beginnings(parse_pcd, compressed()), 0U);
}

TEST(Pcd, SaysWhatIsWrongAndWhere) {
  EXPECT_TRUE(mentions(error_of(parse_pcd, "VERSION 0.7\n"), "DATA"));
  EXPECT_TRUE(mentions(error_of(parse_pcd, "COLOUR red\nDATA ascii\n"), "line 1: COLOUR: unknown word"));
  EXPECT_TRUE(mentions(error_of(parse_pcd, "WIDTH 1\nDATA ascii\n"), "FIELDS"));
  EXPECT_TRUE(
      mentions(error_of(parse_pcd, "FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 1\n"), "'z'"));
  EXPECT_TRUE(mentions(error_of(parse_pcd, "FIELDS x y z\nSIZE 4 4\n"), "line 2: SIZE"));
  EXPECT_TRUE(mentions(error_of(parse_pcd, "FIELDS x y z\nSIZE 3 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n"),
                       "SIZE and TYPE"));
  EXPECT_TRUE(mentions(error_of(parse_pcd, "FIELDS x y z\nSIZE 4 4 4\nTYPE F F Q\nPOINTS 1\nDATA ascii\n"),
                       "SIZE and TYPE"));
  EXPECT_TRUE(
      mentions(error_of(parse_pcd, "FIELDS x y z\nPOINTS 1\nDATA zip\n1 1 1\n"), "line 3: DATA must be"));
  EXPECT_TRUE(mentions(error_of(parse_pcd, "FIELDS x y z\nPOINTS 2\nDATA ascii\n1 1 1 1\n2 2      \n"),
                       "line 5: a point needs 3"));
  EXPECT_TRUE(
      mentions(error_of(parse_pcd, header("binary", "WIDTH 2\nHEIGHT 2\nPOINTS 3\n")), "contradicts"));
  EXPECT_TRUE(
      mentions(error_of(parse_pcd, header("binary", "WIDTH 4294967295\nHEIGHT 4294967295\n")), "too large"));
  EXPECT_TRUE(
      mentions(error_of(parse_pcd, header("binary", "POINTS 4294967295\n") + point(0)), "room for 1"));
  EXPECT_TRUE(mentions(error_of(parse_pcd, header("ascii", "POINTS 4294967295\n") + "1 1 1"), "room"));
}

TEST(Pcd, RefusesCorruptCompression) {
  const std::string good = compressed();
  const std::size_t sizes = good.find("compressed\n") + 11;
  std::string text = good;
  text[sizes] = static_cast<char>(0xFF);  // more packed bytes than there are
  EXPECT_TRUE(mentions(error_of(parse_pcd, text), "cut short"));
  text = good;
  text[sizes + 4] = static_cast<char>(text[sizes + 4] + 1);  // another unpacked size than the points need
  EXPECT_TRUE(mentions(error_of(parse_pcd, text), "do not fit"));
  text = good;
  text[sizes + 8] = static_cast<char>(0x20);  // refers back to before the beginning
  EXPECT_TRUE(mentions(error_of(parse_pcd, text), "corrupt"));
  // Small data that promise to unpack to very much.
  EXPECT_TRUE(
      mentions(error_of(parse_pcd, "FIELDS x y z\nPOINTS 300000000\nDATA binary_compressed\n" +
                                       raw<std::uint32_t>(4) + raw<std::uint32_t>(3600000000U) + "abcd"),
               "corrupt"));
}

TEST(Lzf, UnpacksReferencesThatOverlap) {
  // "ab", then 9 + 2 bytes from two back: a long reference, its length in a byte of its own.
  const std::string packed = std::string("\x01", 1) + "ab" + static_cast<char>(7 << 5) + '\x02' + '\x01';
  std::string plain(13, ' ');
  const std::span<std::byte> out(static_cast<std::byte*>(static_cast<void*>(plain.data())), plain.size());
  ASSERT_TRUE(lzf_unpack(bytes_of(packed), out));
  EXPECT_EQ(plain, "ababababababa");
  EXPECT_FALSE(lzf_unpack(bytes_of(packed), out.first(12)));
  EXPECT_FALSE(lzf_unpack(bytes_of(packed.substr(0, packed.size() - 1)), out));
}

}  // namespace
}  // namespace pliant
