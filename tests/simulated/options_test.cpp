#include "drivers/simulated/options.hpp"

#include <gtest/gtest.h>

#include <string>

namespace pliant::simulated {
namespace {

std::string fault(std::string_view text) {
  const Result<Options> options = parse_options(text);
  if (options) return "read";
  EXPECT_EQ(options.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(options.error().message.find('\n'), std::string::npos);
  EXPECT_LT(options.error().message.size(), 250U);
  return options.error().message;
}

TEST(SimulatedOptions, DefaultsAreAsDocumented) {
  const Result<Options> options = parse_options("cushion");
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->object, ObjectKind::cushion);
  EXPECT_EQ(options->seed, 1U);
  EXPECT_TRUE(options->noise);
  EXPECT_EQ(options->frames, 300);
  EXPECT_EQ(options->width, 640);
  EXPECT_EQ(options->height, 480);
}

TEST(SimulatedOptions, EveryKeyIsRead) {
  const Result<Options> options =
      parse_options("simulated:box?seed=4294967295&noise=none&frames=7&width=320&height=240");
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->object, ObjectKind::box);
  EXPECT_EQ(options->seed, 4294967295U);
  EXPECT_FALSE(options->noise);
  EXPECT_EQ(options->frames, 7);
  EXPECT_EQ(options->width, 320);
  EXPECT_EQ(options->height, 240);
  EXPECT_TRUE(parse_options("figure?noise=structure"));
  EXPECT_TRUE(parse_options("figure?"));
  EXPECT_EQ(parse_options("box")->motion, Motion::handled);
  EXPECT_EQ(parse_options("box?motion=turned")->motion, Motion::turned);
  EXPECT_EQ(parse_options("box?motion=circled")->motion, Motion::circled);
  EXPECT_EQ(parse_options("box?motion=carried")->motion, Motion::carried);
}

TEST(SimulatedOptions, WhatIsUnknownIsNamedWithItsNeighbour) {
  EXPECT_EQ(fault("cushon"),
            "simulated: unknown object 'cushon'; nearest known is 'cushion' of cushion, figure, box");
  EXPECT_NE(fault("").find("unknown object ''"), std::string::npos);
  EXPECT_NE(fault("box?sed=3").find("unknown key 'sed'; nearest known is 'seed'"), std::string::npos);
  EXPECT_NE(fault("box?motion=turn").find("unknown motion 'turn'; nearest known is 'turned'"),
            std::string::npos);
  EXPECT_NE(fault("box?noise=structured").find("nearest known is 'structure'"), std::string::npos);
  EXPECT_NE(fault(std::string(100000, 'x')), "read");
}

TEST(SimulatedOptions, WhatIsOutOfRangeIsNamedWithTheRange) {
  EXPECT_EQ(fault("box?frames=0"), "simulated: frames=0 must be a whole number from 1 to 10000000");
  for (const char* text :
       {"box?frames=", "box?frames=1.5", "box?seed=-1", "box?seed=4294967296", "box?width=159",
        "box?width=1281", "box?height=2000", "box?width=99999999999999999999"})
    EXPECT_NE(fault(text).find("must be a whole number"), std::string::npos) << text;
  EXPECT_NE(fault("box?frames").find("must be key=value"), std::string::npos);
  EXPECT_NE(fault("box?&&").find("must be key=value"), std::string::npos);
}

}  // namespace
}  // namespace pliant::simulated
