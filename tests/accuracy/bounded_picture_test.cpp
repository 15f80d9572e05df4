// What no search in a depth picture may do: take more than twice the usual work, whatever the picture shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "tests/accuracy/registration_runs.hpp"
#include "tests/accuracy/view_maker.hpp"
#include "tests/core/bumpy_object.hpp"
#include "tests/frame_of.hpp"

namespace pliant {
namespace {

constexpr int kViews = 7;

/// A closed surface of the given distance from the middle in each direction.
template <typename Radius>
ScaledMesh star(double size, Radius&& radius) {
  ScaledMesh mesh = ball(1);
  Geometry geometry = geometry_of(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3 d = mesh.vertices[i].normalized();
    geometry.vertices[i] = to_point(radius(d) * d);
  }
  return scaled(geometry, size);
}

ScaledMesh target() {
  return star(kSize, testing::bumpy_radius);
}

/// Things of about the object's size with lumps elsewhere.
std::vector<ScaledMesh> others() {
  return {
      ball(0.05), ball(0.15),
      star(kSize, [](const Vector3& d) { return 0.09 + 0.03 * std::sin(5 * d.x()) * std::cos(4 * d.y()); }),
      star(kSize, [](const Vector3& d) { return 0.08 + 0.05 * d.z() * d.z() + 0.02 * std::sin(9 * d.y()); })};
}

class PictureRun {
 public:
  PictureRun()
      : target_(target()),
        model_(geometry_of(target_)),
        run_(model_.view, table_size(camera_.width, camera_.height)) {}

  [[nodiscard]] bool ready() const { return model_.good && run_.fault == nullptr; }
  [[nodiscard]] const ScaledMesh& mesh() const { return target_; }

  /// Work of a registration; `found` says how it ended.
  std::uint64_t work_of(const char* name, const std::vector<std::uint16_t>& picture, bool& found) {
    const double start = thread_ms();
    const RegistrationResult& result =
        run_.registration.register_depth(test::frame_of(picture, camera_), camera_, SensorDescription());
    found = result.outcome == RegistrationOutcome::found;
    std::printf("%-24s %6.1f million instructions, about, %5.1f ms\n", name,
                static_cast<double>(result.work) * 1e-6, thread_ms() - start);
    return result.work;
  }

  /// The median work of views in which the object is found, and the most of the same views without it.
  void usual(std::uint64_t& middle, std::uint64_t& most_empty) {
    const std::vector<ScaledMesh> things = others();
    ViewMaker maker(target_, things);
    std::vector<std::uint64_t> works;
    most_empty = 0;
    std::uint64_t seed = 1;
    for (int made = 0; made < kViews; ++seed) {
      View view;
      if (!maker.make(seed, view)) continue;
      ++made;
      bool found = false;
      const std::uint64_t work = work_of("usual", view.with, found);
      if (found) works.push_back(work);
      most_empty = std::max(most_empty, work_of("the same without it", view.without, found));
    }
    ASSERT_GT(2 * works.size(), static_cast<std::size_t>(kViews));
    std::sort(works.begin(), works.end());
    middle = works[works.size() / 2];
  }

 private:
  Intrinsics camera_ = structure_camera();
  ScaledMesh target_;
  BuiltFromFile model_;
  ReadyRegistration run_;
};

/// Balls in rows before a wall, or copies of the object.
std::vector<std::uint16_t> picture_of_many(const ScaledMesh& mesh, bool turned) {
  const Intrinsics camera = structure_camera();
  simulated::DisparityImage image(camera);
  std::mt19937 random(5);
  image.draw_plane(
      Vector3(0, 0, 1), 1.6, [](const Vector3&, const void*) { return true; }, nullptr);
  for (int row = -1; row <= 1; ++row)
    for (int column = -1; column <= 1; ++column) {
      RigidTransform pose;
      if (turned) pose.rotation = random_rotation(random);
      pose.translation = Vector3(0.36 * column, 0.3 * row, 1.1);
      image.draw(placed(mesh, pose), mesh.triangles, {});
    }
  std::vector<std::uint16_t> picture(image.pixels().size());
  simulated::StructureSensor(camera, SensorDescription(), 1).measure(image, 0, picture);
  return picture;
}

std::vector<std::uint16_t> noise() {
  std::mt19937 random(7);
  std::vector<std::uint16_t> picture(640 * 480);
  for (std::uint16_t& d : picture) d = static_cast<std::uint16_t>(700 + random() % 600);
  return picture;
}

TEST(BoundedWork, AwkwardPicturesTakeAtMostTwiceTheUsualWork) {
  PictureRun run;
  ASSERT_TRUE(run.ready());
  std::uint64_t usual = 0, most_empty = 0;
  run.usual(usual, most_empty);
  EXPECT_GT(usual, 100000000U);
  EXPECT_LE(most_empty, 2 * usual);
  bool found = false;
  EXPECT_LE(run.work_of("all descriptors equal", picture_of_many(ball(0.08), false), found), 2 * usual);
  EXPECT_LE(run.work_of("nothing but noise", noise(), found), 2 * usual);
  EXPECT_FALSE(found);
  EXPECT_LE(run.work_of("the object nine times", picture_of_many(run.mesh(), true), found), 2 * usual);
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace pliant
