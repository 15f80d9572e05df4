// Which shapes a depth camera can localise.
#include <cstdio>

#include "drivers/model_files/describe_model.hpp"
#include "tests/model_files/built.hpp"
#include "tests/model_files/shapes.hpp"

namespace pliant {
namespace {

using namespace testing;
using Ambiguity = ModelHeader::Ambiguity;

void expect_ambiguous(const Geometry& geometry, Ambiguity ambiguity, const char* word) {
  SCOPED_TRACE(word);
  const Made made = make(geometry);
  EXPECT_FALSE(made.built.characterisable);
  EXPECT_FALSE(made.view().characterisable());
  EXPECT_EQ(made.view().header().ambiguity, static_cast<std::uint32_t>(ambiguity));
  EXPECT_TRUE(mentions(made.built.reason, word)) << made.built.reason;
  EXPECT_TRUE(mentions(describe_model(made.view()), "characterisable: no"));
}

TEST(Shape, ASphereCannotBeLocalised) {
  expect_ambiguous(shapes::sphere(0.1, 60), Ambiguity::sphere, "sphere");
  expect_ambiguous(shapes::sphere(0.1, 10), Ambiguity::sphere, "sphere");  // 200 facets
  expect_ambiguous(shapes::with_noise(shapes::sphere(0.1, 50), 0.001), Ambiguity::sphere, "sphere");
  expect_ambiguous(shapes::cloud_of(shapes::with_noise(shapes::sphere(0.1, 60), 0.0005)), Ambiguity::sphere,
                   "sphere");
  expect_ambiguous(shapes::sphere(0.02, 60), Ambiguity::sphere, "sphere");
}

TEST(Shape, APlaneCannotBeLocalised) {
  expect_ambiguous(shapes::plane(0.3, 0.2, 60), Ambiguity::plane, "plane");
  expect_ambiguous(shapes::plane(0.3, 0.2, 1), Ambiguity::plane, "plane");
  expect_ambiguous(shapes::cloud_of(shapes::with_noise(shapes::plane(0.3, 0.2, 60), 0.0005)),
                   Ambiguity::plane, "plane");
}

TEST(Shape, RoundThingsCannotBeLocalised) {
  expect_ambiguous(shapes::cylinder(0.05, 0.2, 40, true), Ambiguity::rotation, "about an axis");
  expect_ambiguous(shapes::torus(0.1, 0.03, 40), Ambiguity::rotation, "about an axis");
  expect_ambiguous(shapes::ellipsoid(0.1, 0.1, 0.06, 60), Ambiguity::rotation, "about an axis");
  expect_ambiguous(shapes::cylinder(0.05, 0.2, 40, false), Ambiguity::translation, "shifted along itself");
}

TEST(Shape, WhatIsSeenOfARoundThingFromOneSideTurnsAboutItsAxis) {
  for (const double degrees : {180.0, 140.0, 100.0}) {
    SCOPED_TRACE(degrees);
    const Geometry side = shapes::with_noise(shapes::side_of_bottle(degrees, 80), 0.0003);
    expect_ambiguous(side, Ambiguity::rotation, "about an axis");
    const std::string text = describe_model(make(side).view());
    const std::size_t at = text.find("not noticed: a turn about the axis through (");
    ASSERT_NE(at, std::string::npos) << text;
    double x = 0, y = 0, z = 0, along[3] = {0, 0, 0};
    ASSERT_EQ(std::sscanf(text.c_str() + at,
                          "not noticed: a turn about the axis through (%lf %lf %lf) m along (%lf %lf %lf)",
                          &x, &y, &z, &along[0], &along[1], &along[2]),
              6)
        << text;
    EXPECT_NEAR(x, 0.1, 0.004);
    EXPECT_NEAR(y, 0.2, 0.004);
    EXPECT_GT(along[2], 0.99);
  }
}

TEST(Shape, ASlipAlongAndATurnAreToldApart) {
  expect_ambiguous(shapes::with_noise(shapes::angle_bar(80), 0.0003), Ambiguity::translation,
                   "shifted along itself");
  EXPECT_TRUE(mentions(describe_model(make(shapes::angle_bar(80)).view()),
                       "not noticed: a shift along (0.00 1.00 0.00)\n"));
  const std::string pipe = describe_model(make(shapes::cylinder(0.05, 0.2, 40, false)).view());
  EXPECT_TRUE(mentions(pipe, "not noticed: a turn about the axis through (")) << pipe;
  EXPECT_TRUE(mentions(pipe, ") m along (0.00 0.00 1.00) and a shift along (0.00 0.00 1.00)\n")) << pipe;
}

TEST(Shape, OfSeveralMotionsOfAKindNoneIsNamed) {
  for (const Geometry& g : {shapes::sphere(0.1, 60), shapes::plane(0.3, 0.2, 60)})
    EXPECT_FALSE(mentions(describe_model(make(g).view()), "not noticed"));
}

TEST(Shape, ThingsWithEdgesAndKnobsCan) {
  for (const Geometry& g : {shapes::cushion_with_knob(), shapes::box(0.07, 0.09, 0.2),
                            shapes::box(0.03, 0.02, 0.04), shapes::ellipsoid(0.1, 0.08, 0.06, 60)}) {
    const Made made = make(g);
    EXPECT_TRUE(made.built.characterisable) << made.built.reason;
    EXPECT_TRUE(made.view().characterisable());
    EXPECT_EQ(made.built.reason, "");
    EXPECT_TRUE(mentions(describe_model(made.view()), "characterisable: yes"));
  }
}

TEST(Shape, SymmetriesAreNamed) {
  EXPECT_TRUE(warned(make(shapes::box(0.07, 0.09, 0.2)).built, "half a turn"));
  EXPECT_TRUE(warned(make(shapes::box(0.1, 0.1, 0.2)).built, "1/4 of a turn"));
  EXPECT_FALSE(warned(make(shapes::cushion_with_knob()).built, "turn"));
}

}  // namespace
}  // namespace pliant
