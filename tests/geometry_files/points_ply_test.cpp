#include "drivers/geometry_files/points_ply.hpp"

#include "drivers/geometry_files/region_colours.hpp"
#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr const char* kHeader =
    "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty "
    "float z\n"
    "property float rest_x\nproperty float rest_y\nproperty float rest_z\nproperty int region\nproperty int "
    "match\n"
    "property float residual\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";

TEST(PointsPly, WritesTheDocumentedLayoutAgainAndAgain) {
  const TemporaryFolder folder;
  const std::string path = (folder / "000000.ply").string();
  const std::vector<Point3f> rest = {{1, 2, 3}, {4, 5, 6}};
  PointsPlyWriter writer(rest);
  for (int frame = 0; frame < 2; ++frame) {
    const float shift = static_cast<float>(frame);
    const std::vector<Point3f> now = {{shift, 8, 9}, {10, 11, 12}};
    const std::vector<std::int8_t> labels = {static_cast<std::int8_t>(frame), -2};
    const std::vector<std::int32_t> matches = {76799, -1};
    const std::vector<float> residuals = {0.001F, 0};
    ASSERT_TRUE(writer.write(path.c_str(), now, labels, matches, residuals));
    std::string expected = kHeader;
    for (std::size_t i = 0; i < 2; ++i) {
      expected +=
          raw(now[i].x) + raw(now[i].y) + raw(now[i].z) + raw(rest[i].x) + raw(rest[i].y) + raw(rest[i].z);
      expected += raw<std::int32_t>(labels[i]) + raw(matches[i]) + raw(residuals[i]);
      const RegionColour colour = region_colour(labels[i]);
      expected += raw(colour.red) + raw(colour.green) + raw(colour.blue);
    }
    EXPECT_EQ(contents(path), expected);
    EXPECT_EQ(writer.file_bytes(), expected.size());
  }
  const Result<Geometry> back = read_geometry(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_FLOAT_EQ(back->vertices[1].z, 12);
}

TEST(PointsPly, AFailedWriteLeavesNothing) {
  const TemporaryFolder folder;
  PointsPlyWriter writer(std::vector<Point3f>(2));
  const std::vector<Point3f> now(2);
  const std::vector<std::int8_t> labels(2);
  const std::vector<std::int32_t> matches(2);
  const std::vector<float> residuals(2);
  const Outcome no_folder =
      writer.write((folder / "none" / "0.ply").c_str(), now, labels, matches, residuals);
  ASSERT_FALSE(no_folder);
  EXPECT_EQ(no_folder.error().kind, ErrorKind::write);
  const Outcome wrong_size =
      writer.write((folder / "0.ply").c_str(), now, labels, matches, std::span(residuals).first(1));
  ASSERT_FALSE(wrong_size);
  EXPECT_EQ(folder.count(), 0U);
}

}  // namespace
}  // namespace pliant
