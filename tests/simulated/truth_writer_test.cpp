#include "drivers/simulated/truth_writer.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "drivers/recording/text_file.hpp"
#include "tests/temporary_folder.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class TruthWriterTest : public testing::Test {
 protected:
  [[nodiscard]] std::string content(const fs::path& name) const {
    const Result<std::string> text = read_text_file(folder_ / name, 1 << 24);
    return text ? *text : text.error().message;
  }

  const test::TemporaryFolder made_;
  fs::path folder_ = made_.path();
};

TEST_F(TruthWriterTest, WritesTheMeshAndEveryVertexOfEveryFrame) {
  auto source = open_simulated("cushion?frames=2&width=320&height=240");
  ASSERT_TRUE(source);
  const Geometry& mesh = (*source)->mesh();
  auto writer = TruthWriter::create(folder_, mesh);
  ASSERT_TRUE(writer) << writer.error().message;
  SourceItem item;
  (*source)->next(0, item);
  ASSERT_TRUE((*writer)->write(0, (*source)->truth()));

  const std::string model = content("model.ply");
  const std::size_t model_body = model.find("end_header\n") + 11;
  EXPECT_EQ(model.size(), model_body + 24 * mesh.vertices.size() + 13 * mesh.triangles.size());

  const std::string frame = content("truth/000000.ply");
  const std::size_t body = frame.find("end_header\n") + 11;
  ASSERT_EQ(frame.size(), body + 14 * mesh.vertices.size());
  const SimulatedTruth& truth = (*source)->truth();
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 97) {
    Point3f p;
    std::memcpy(&p, frame.data() + body + 14 * i, sizeof p);
    EXPECT_EQ(p.x, truth.vertices[i].x);
    EXPECT_EQ(p.z, truth.vertices[i].z);
    EXPECT_EQ(static_cast<std::uint8_t>(frame[body + 14 * i + 12]), truth.visible[i]);
    EXPECT_EQ(static_cast<std::int8_t>(frame[body + 14 * i + 13]), truth.vertex_part[i]);
  }
  EXPECT_EQ(content("truth/poses.txt")
                .rfind("# seconds frame present part tx ty tz qx qy qz qw\n0.000000 0 1 0 ", 0),
            0U);
  EXPECT_TRUE((*writer)->finish());
  EXPECT_FALSE((*writer)->write(1, truth));
}

TEST_F(TruthWriterTest, FailuresAreTyped) {
  const auto nowhere = TruthWriter::create("/proc/nowhere", Geometry{});
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().kind, ErrorKind::write);
}

}  // namespace
}  // namespace pliant
