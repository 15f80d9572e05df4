// The fingerprints that the encoder writes are those that lcm-gen gives every subscriber.
#include "drivers/lcm/fingerprint.hpp"

#include <gtest/gtest.h>

#include "bot_core/rigid_transform_t.hpp"
#include "pliant/deformed_t.hpp"
#include "pliant/depth_t.hpp"
#include "pliant/model_t.hpp"
#include "pliant/region_t.hpp"
#include "pliant/regions_t.hpp"
#include "pliant/status_t.hpp"

namespace pliant {
namespace {

TEST(LcmFingerprint, IsTheGeneratedOne) {
  EXPECT_EQ(wire::kPoseFingerprint, static_cast<std::uint64_t>(bot_core::rigid_transform_t::getHash()));
  EXPECT_EQ(wire::kRegionFingerprint, static_cast<std::uint64_t>(region_t::getHash()));
  EXPECT_EQ(wire::kRegionsFingerprint, static_cast<std::uint64_t>(regions_t::getHash()));
  EXPECT_EQ(wire::kDeformedFingerprint, static_cast<std::uint64_t>(deformed_t::getHash()));
  EXPECT_EQ(wire::kDepthFingerprint, static_cast<std::uint64_t>(depth_t::getHash()));
  EXPECT_EQ(wire::kStatusFingerprint, static_cast<std::uint64_t>(status_t::getHash()));
  EXPECT_EQ(wire::kModelFingerprint, static_cast<std::uint64_t>(model_t::getHash()));
}

TEST(LcmFingerprint, PoseIsThatOfTheOriginalBotCoreType) {
  // lcm-gen's value for bot_core_rigid_transform_t.lcm as the bot_core message package ships it.
  EXPECT_EQ(wire::kPoseFingerprint, 0xEA9FFBF2ACC5C5AEU);
}

TEST(LcmFingerprint, TellsTypesNamesOrderAndDimensionsApart) {
  using Builder = wire::FingerprintBuilder;
  const auto reference = Builder().field("int8_t", "a").field("float", "b", {{"3"}}).value();
  EXPECT_NE(reference, Builder().field("int16_t", "a").field("float", "b", {{"3"}}).value());
  EXPECT_NE(reference, Builder().field("int8_t", "c").field("float", "b", {{"3"}}).value());
  EXPECT_NE(reference, Builder().field("float", "b", {{"3"}}).field("int8_t", "a").value());
  EXPECT_NE(reference, Builder().field("int8_t", "a").field("float", "b", {{"4"}}).value());
  EXPECT_NE(reference, Builder().field("int8_t", "a").field("float", "b", {{"3", true}}).value());
}

}  // namespace
}  // namespace pliant
