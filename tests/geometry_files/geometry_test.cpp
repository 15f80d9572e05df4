#include "drivers/geometry_files/geometry.hpp"

#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

TEST(ReadGeometry, ChoosesByContentWhateverTheName) {
  const TemporaryFolder folder;
  put(folder / "a.stl",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n1 2 3\n");
  put(folder / "b.txt", "# made by hand\nv 1 2 3\n");
  put(folder / "c", "OFF\n1 0 0\n1 2 3\n");
  put(folder / "d.xyz", "# .PCD v0.7\nFIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n");
  for (const char* name : {"a.stl", "b.txt", "c", "d.xyz"}) {
    const Result<Geometry> g = read_geometry(folder / name);
    ASSERT_TRUE(g) << g.error().message;
    ASSERT_EQ(g->vertices.size(), 1U);
    EXPECT_FLOAT_EQ(g->vertices[0].z, 3);
  }
}

TEST(ReadGeometry, SaysWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& name) {
    const Result<Geometry> g = read_geometry(folder / name);
    EXPECT_FALSE(g);
    if (g) return std::string();
    EXPECT_EQ(g.error().kind, ErrorKind::bad_input);
    EXPECT_TRUE(mentions(g.error().message, name));
    return g.error().message;
  };
  EXPECT_TRUE(mentions(error("missing.ply"), "No such file"));
  EXPECT_TRUE(mentions(error(""), "folder"));
  put(folder / "empty.ply", "");
  EXPECT_TRUE(mentions(error("empty.ply"), "is empty"));
  put(folder / "zipped.ply", "\x1f\x8b\x08");
  EXPECT_TRUE(mentions(error("zipped.ply"), "gunzip"));
  put(folder / "model.ply", "PLIANTM\n");
  EXPECT_TRUE(mentions(error("model.ply"), "model file already"));
  put(folder / "picture.ply", "\x89PNG\r\n");
  EXPECT_TRUE(mentions(error("picture.ply"), "picture"));
  put(folder / "odd", "hello world\n");
  EXPECT_TRUE(mentions(error("odd"), "unknown format"));
  put(folder / "odd.PLY", "hello world\n");
  EXPECT_TRUE(mentions(error("odd.PLY"), "begins with 'ply'"));
}

TEST(WritePly, IsReadBackTheSame) {
  const TemporaryFolder folder;
  Geometry g;
  g.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1e-7F, -3}};
  g.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  g.triangles = {{0, 1, 2}};
  ASSERT_TRUE(write_ply(folder / "out.ply", g));
  const Result<Geometry> back = read_geometry(folder / "out.ply");
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->vertices.size(), 3U);
  EXPECT_EQ(back->vertices[2].y, 1e-7F);
  EXPECT_EQ(back->normals[1].y, 1);
  EXPECT_EQ(back->triangles, g.triangles);
  EXPECT_EQ(folder.count(), 1U);
}

}  // namespace
}  // namespace pliant
