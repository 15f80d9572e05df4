#include "firmware-app/config/sensor_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace pliant {
namespace {

TEST(SensorFile, EveryShippedDescriptionIsValid) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PLIANT_CONFIG_FOLDER "/sensors")) {
    const Result<SensorFile> sensor = read_sensor(entry.path().string());
    ASSERT_TRUE(sensor) << sensor.error().message;
    EXPECT_FALSE(sensor->name.empty());
    ++count;
  }
  EXPECT_GE(count, 1);
}

TEST(SensorFile, NearMustBeBelowFar) {
  SensorFile sensor;
  const Outcome parsed = parse_sensor("[noise]\nnear_limit = 3\nfar_limit = 2\n", "s.toml", sensor);
  ASSERT_FALSE(parsed);
  EXPECT_NE(parsed.error().message.find("near_limit must be less than"), std::string::npos);
}

TEST(SensorFile, AUnitHasOneRange) {
  for (const char* scale : {"10", "200000", "1000000"}) {
    SensorFile sensor;
    const Outcome parsed =
        parse_sensor(std::string("[camera]\ndepth_scale = ") + scale + "\n", "s.toml", sensor);
    EXPECT_TRUE(parsed) << parsed.error().message;
  }
  for (const char* scale : {"5", "9.9", "2000000"}) {
    SensorFile sensor;
    const Outcome parsed =
        parse_sensor(std::string("[camera]\ndepth_scale = ") + scale + "\n", "s.toml", sensor);
    ASSERT_FALSE(parsed);
    EXPECT_NE(
        parsed.error().message.find("s.toml:2:15: camera.depth_scale must be a number from 10 to 1e+06"),
        std::string::npos)
        << parsed.error().message;
  }
}

TEST(SensorFile, RangesHold) {
  SensorFile sensor;
  EXPECT_FALSE(parse_sensor("[mode]\nwidth = 31\n", "s.toml", sensor));
  EXPECT_FALSE(parse_sensor("[camera]\nfx = 0\n", "s.toml", sensor));
  EXPECT_FALSE(parse_sensor("[noise]\nnoise_flor = 0.001\n", "s.toml", sensor));
  EXPECT_TRUE(parse_sensor("[mode]\nwidth = 320\nheight = 240\n", "s.toml", sensor));
  EXPECT_EQ(sensor.intrinsics().width, 320);
}

}  // namespace
}  // namespace pliant
