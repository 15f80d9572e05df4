// Pictures and plots: that what is drawn is where and what it should be.
#include <gtest/gtest.h>

#include <fstream>

#include "core/track_result.hpp"
#include "firmware-app/pictures/displacement_colours.hpp"
#include "firmware-app/pictures/scene_picture.hpp"
#include "firmware-app/pictures/stats_plot.hpp"
#include "firmware-app/pictures/svg.hpp"
#include "firmware-app/pictures/trajectory_errors.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

RegionColour pixel(const Canvas& canvas, int u, int v) {
  const std::size_t at = 3 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(canvas.width()) +
                              static_cast<std::size_t>(u));
  return {canvas.rgb()[at], canvas.rgb()[at + 1], canvas.rgb()[at + 2]};
}

/// Drawn with an opacity of 80 %.
void expect_colour(RegionColour got, RegionColour wanted) {
  EXPECT_NEAR(got.red, wanted.red, 55);
  EXPECT_NEAR(got.green, wanted.green, 55);
  EXPECT_NEAR(got.blue, wanted.blue, 55);
}

TEST(DisplacementColours, DarkenWithLengthAndStayAtTheirEnds) {
  int before = 1000;
  for (const double at : {0.0, 0.3, 0.6, 1.0}) {
    const RegionColour colour = displacement_colour(at, 1);
    const int lightness = colour.red + colour.green + colour.blue;
    EXPECT_LT(lightness, before);
    before = lightness;
  }
  EXPECT_EQ(displacement_colour(7, 1).red, displacement_colour(1, 1).red);
  EXPECT_EQ(displacement_colour(-7, 1).green, displacement_colour(0, 1).green);
}

TEST(DisplacementColours, TheScaleEndsAtARoundLength) {
  EXPECT_DOUBLE_EQ(displacement_scale({}), 0.005);
  const std::vector<float> lengths = {0.011F, 0.0123F, 0};
  EXPECT_DOUBLE_EQ(displacement_scale(lengths), 0.02);
  std::vector<float> with_a_stray(40, 0.018F);
  with_a_stray.push_back(0.9F);
  EXPECT_DOUBLE_EQ(displacement_scale(with_a_stray), 0.02);
}

TEST(ScenePicture, PointsAreDrawnWhereTheCameraSeesThem) {
  const std::vector<Point3f> positions = {{0, 0, 1}, {0.2F, 0.1F, 1}, {-0.2F, 0.1F, 1}, {0.2F, -0.1F, 1}};
  const std::vector<std::int8_t> labels = {0, kDeformed, kNotObserved, 1};
  const std::vector<float> displacement = {0, 0.02F, 0, 0};
  SceneView view;
  view.camera = {.width = 640, .height = 480, .fx = 500, .fy = 500, .cx = 320, .cy = 240};
  view.positions = positions;
  view.labels = labels;
  view.displacement = displacement;
  view.spacing = 0.02;
  const Canvas canvas = draw_scene(view);
  expect_colour(pixel(canvas, 320, 240), region_colour(0));
  expect_colour(pixel(canvas, 420, 290), displacement_colour(0.02, 0.02));
  expect_colour(pixel(canvas, 420, 190), region_colour(1));
  expect_colour(pixel(canvas, 220, 290), {0, 0, 0});  // not observed: not drawn
}

TEST(ScenePicture, WithoutACameraOneIsChosenThatShowsAll) {
  const std::vector<Point3f> points = {{0.3F, 0.2F, 0.8F}, {0.5F, 0.25F, 1.2F}, {0.35F, 0.4F, 0.9F}};
  const Intrinsics camera = camera_that_shows(points, 640, 480);
  for (const Point3f& p : points) {
    const double u = camera.fx * static_cast<double>(p.x / p.z) + camera.cx;
    const double v = camera.fy * static_cast<double>(p.y / p.z) + camera.cy;
    EXPECT_TRUE(u > 20 && u < 620 && v > 20 && v < 460) << u << " " << v;
  }
}

TEST(Svg, WordsCannotBreakIt) {
  Svg svg(100, 50);
  svg.text(1, 2, "<script>&\x01");
  EXPECT_NE(svg.finished().find("&lt;script>&amp;<"), std::string::npos) << svg.finished();
}

TEST(Svg, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(round_step(0.7, 4), 0.2);
  EXPECT_DOUBLE_EQ(round_step(100, 100), 1);
}

class TrajectoryErrors : public CommandTest {};

TEST_F(TrajectoryErrors, AreThoseOfTheSameTime) {
  // A shift of 3 mm and 4 mm, and a turn of 90 degrees; the pose at 2.0 s has no companion.
  write_file(at("truth"), "# comment\n1.0 0 0 1 0 0 0 1\n1.5 0 0 1 0 0 0 1\n");
  write_file(at("path"),
             "1.0005 0.003 0.004 1 0 0 0 1\n1.5 0 0 1 0 0 0.70710678 0.70710678\n2.0 0 0 1 0 0 0 1\n");
  const auto errors = trajectory_errors(at("path"), at("truth"));
  ASSERT_TRUE(errors) << errors.error().message;
  ASSERT_EQ(errors->size(), 2U);
  EXPECT_NEAR(errors->at(0).shift, 0.005, 1e-9);
  EXPECT_NEAR(errors->at(0).angle, 0, 1e-6);
  EXPECT_NEAR(errors->at(1).angle, 90, 1e-5);
  EXPECT_NEAR(errors->at(1).seconds, 0.4995, 1e-9);
}

TEST_F(TrajectoryErrors, MalformedPathsNameTheLine) {
  write_file(at("truth"), "1.0 0 0 1 0 0 0 1\n");
  write_file(at("path"), "1.0 0 0 1 0 0 0 1\n1.1 0 0 1 0 0 0\n");
  EXPECT_NE(trajectory_errors(at("path"), at("truth")).error().message.find("path:2:"), std::string::npos);
  write_file(at("path"), "9.0 0 0 1 0 0 0 1\n");
  EXPECT_NE(trajectory_errors(at("path"), at("truth")).error().message.find("same time"), std::string::npos);
}

}  // namespace
}  // namespace pliant::test
