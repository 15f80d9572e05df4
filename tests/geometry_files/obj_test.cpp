#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

TEST(Obj, ReadsVerticesFacesColoursAndComments) {
  const Geometry g = parsed(parse_obj,
                            "# a square\nmtllib a.mtl\no thing\nv 0 0 0 0.5 0.5 0.5\nv 1 0 0 1.0\nv 1 1 0\n"
                            "v 0 1 +1e-1\nvt 0 0\nusemtl grey\ns off\nf 1/1 2/1 3/1 4/1 # all of it\n");
  ASSERT_EQ(g.vertices.size(), 4U);
  EXPECT_FLOAT_EQ(g.vertices[3].z, 0.1F);
  ASSERT_EQ(g.triangles.size(), 2U);
  EXPECT_EQ(g.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_TRUE(g.normals.empty());
}

TEST(Obj, NegativeNumbersCountFromTheEnd) {
  const Geometry g = parsed(parse_obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 9 9 9\nf 1 -2 -1\r\n");
  ASSERT_EQ(g.triangles.size(), 2U);
  EXPECT_EQ(g.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(g.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST(Obj, TakesNormalsFromFacesOrOneAVertex) {
  const Geometry mesh =
      parsed(parse_obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nvn 0 0 2\nvn 1 0 0\nf 1//1 2//1 3/7/2\n");
  ASSERT_EQ(mesh.normals.size(), 4U);
  EXPECT_FLOAT_EQ(mesh.normals[0].z, 2);
  EXPECT_FLOAT_EQ(mesh.normals[2].x, 1);
  EXPECT_FLOAT_EQ(mesh.normals[3].x, 0);
  const Geometry cloud = parsed(parse_obj, "v 0 0 0\nv 1 0 0\nvn 0 0 1\nvn 0 1 0\n");
  ASSERT_EQ(cloud.normals.size(), 2U);
  EXPECT_FLOAT_EQ(cloud.normals[1].y, 1);
}

TEST(Obj, JoinsLinesThatGoOn) {
  EXPECT_EQ(parsed(parse_obj, "v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n2 \\\n3\n").triangles.size(), 1U);
  EXPECT_EQ(parsed(parse_obj, "v 0 0 0\\").vertices.size(), 1U);
}

TEST(Obj, SaysWhatIsWrongAndWhere) {
  EXPECT_TRUE(mentions(error_of(parse_obj, "# nothing\n"), "no points"));
  EXPECT_TRUE(mentions(error_of(parse_obj, "v 0 0 0\nv 0 0\n"), "line 2: a vertex needs three numbers"));
  EXPECT_TRUE(mentions(error_of(parse_obj, "vn 0 x 0\n"), "line 1: a normal"));
  EXPECT_TRUE(mentions(error_of(parse_obj, "v 0 0 0\nf 1 1\n"), "line 2: a face needs three"));
  for (const char* corner : {"0", "2", "-2", "x", "", "99999999999999999999", "1.5", "9223372036854775807",
                             "-9223372036854775808"}) {
    const std::string text = "v 0 0 0\nf 1 1 " + std::string(corner) + "/\n";
    EXPECT_TRUE(mentions(error_of(parse_obj, text), "line 2: ")) << corner;
  }
  EXPECT_TRUE(mentions(error_of(parse_obj, "v 0 0 0\nf 1//1 1//1 1//1\n"), "normals above it"));
}

}  // namespace
}  // namespace pliant
