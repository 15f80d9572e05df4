#include "drivers/recording/camera_file.hpp"

#include <gtest/gtest.h>

#include <string>

namespace pliant {
namespace {

const std::string kGood =
    "width = 640\nheight = 480\nfx = 570.5\nfy = 571\ncx = 320.0\ncy = 240.25\ndepth_scale = 1000\n";

std::string fault(const std::string& text) {
  const Result<CameraFile> camera = parse_camera(text, "camera.toml");
  if (camera) return "read";
  EXPECT_EQ(camera.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(camera.error().message.find('\n'), std::string::npos);
  return camera.error().message;
}

TEST(CameraFile, ReadsTheSixNumbersAndTheScale) {
  const Result<CameraFile> camera = parse_camera(kGood, "camera.toml");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->intrinsics.width, 640);
  EXPECT_EQ(camera->intrinsics.height, 480);
  EXPECT_EQ(camera->intrinsics.fx, 570.5);
  EXPECT_EQ(camera->intrinsics.fy, 571.0);
  EXPECT_EQ(camera->intrinsics.cx, 320.0);
  EXPECT_EQ(camera->intrinsics.cy, 240.25);
  EXPECT_EQ(camera->intrinsics.depth_scale, 1000.0);
  EXPECT_EQ(camera->sensor.noise_floor, SensorDescription{}.noise_floor);
}

TEST(CameraFile, ReadsTheSensorAndTheFloatsOfOtherWriters) {
  const Result<CameraFile> camera = parse_camera(
      "# made elsewhere\r\nwidth = 640.0\r\nheight = 480\r\nfx = 5.7e2\r\nfy = 570\r\ncx = 320\r\ncy = "
      "240\r\n"
      "depth_scale = 8000.0\r\n[sensor]\r\nnoise_floor = 0.0004\r\nnoise_growth = 0.003\r\n"
      "near_limit = 0.4\r\nfar_limit = 3.5\r\n",
      "camera.toml");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->intrinsics.width, 640);
  EXPECT_EQ(camera->intrinsics.fx, 570.0);
  EXPECT_EQ(camera->intrinsics.depth_scale, 8000.0);
  EXPECT_EQ(camera->sensor.noise_floor, 0.0004);
  EXPECT_EQ(camera->sensor.noise_growth, 0.003);
  EXPECT_EQ(camera->sensor.near_limit, 0.4);
  EXPECT_EQ(camera->sensor.far_limit, 3.5);
}

TEST(CameraFile, TextReadsBackTheSame) {
  CameraFile camera;
  camera.intrinsics = {1280, 720, 911.123456789012, 910.1, 640.25, 359.75, 8000};
  camera.sensor = {0.0003, 0.0021, 0.25, 6};
  const Result<CameraFile> back = parse_camera(camera_text(camera), "camera.toml");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->intrinsics.width, 1280);
  EXPECT_EQ(back->intrinsics.height, 720);
  EXPECT_EQ(back->intrinsics.fx, 911.123456789012);
  EXPECT_EQ(back->intrinsics.cy, 359.75);
  EXPECT_EQ(back->sensor.noise_growth, 0.0021);
  EXPECT_EQ(back->sensor.near_limit, 0.25);
}

TEST(CameraFile, AnUnknownKeyIsNamedWithPlaceAndNeighbour) {
  EXPECT_EQ(fault(kGood + "depth_scal = 3\n"),
            "camera.toml:8:1: unknown key 'depth_scal'; nearest known key is 'depth_scale'");
  EXPECT_EQ(fault(kGood + "[sensor]\n  noise_flor = 0.001\n"),
            "camera.toml:9:3: unknown key 'noise_flor'; nearest known key is 'noise_floor'");
  EXPECT_NE(fault(kGood + "[senor]\nx = 1\n").find("nearest known key is 'sensor'"), std::string::npos);
}

TEST(CameraFile, WrongValuesAreNamedWithTheirPlace) {
  EXPECT_NE(fault("width = \"640\"\n").find("camera.toml:1:9: 'width' must be a number"), std::string::npos);
  EXPECT_NE(fault("width = 1e9\n").find("must be 32 to 1920"), std::string::npos);
  EXPECT_NE(fault("fx = nan\n").find("camera.toml:1:6: 'fx' is nan"), std::string::npos);
  EXPECT_NE(fault("fx = true\n").find("must be a number"), std::string::npos);
  EXPECT_NE(fault("sensor = 3\n").find("must be a table"), std::string::npos);
  EXPECT_NE(fault(kGood + "[sensor]\nnoise_floor = 1.0\n").find("0.0001 to 0.05"), std::string::npos);
  EXPECT_NE(fault(kGood + "[sensor]\nnear_limit = 3.0\nfar_limit = 2.0\n").find("less than"),
            std::string::npos);
}

TEST(CameraFile, MissingKeysAreNamed) {
  EXPECT_EQ(fault(""), "camera.toml: 'width' is missing");
  EXPECT_EQ(fault(kGood.substr(0, kGood.find("depth_scale"))), "camera.toml: 'depth_scale' is missing");
  std::string half = kGood;
  half.replace(half.find("640"), 3, "640.5");
  EXPECT_NE(fault(half).find("whole numbers"), std::string::npos);
}

TEST(CameraFile, WhatIsNoTomlIsNamedWithItsPlace) {
  EXPECT_EQ(fault("width = 640\nheight 480\n").rfind("camera.toml:2:", 0), 0U);
  EXPECT_EQ(fault("width = 640\nwidth = 640\n").rfind("camera.toml:2:", 0), 0U);
  EXPECT_NE(fault(std::string("\0\0\xff\xfe", 4)), "read");
}

TEST(CameraFile, AMissingFileIsNamed) {
  const Result<CameraFile> camera = read_camera("/nonexistent/camera.toml");
  ASSERT_FALSE(camera);
  EXPECT_EQ(camera.error().message, "/nonexistent/camera.toml: No such file or directory");
}

}  // namespace
}  // namespace pliant
