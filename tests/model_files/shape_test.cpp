// Which shapes a depth camera can localise.
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
