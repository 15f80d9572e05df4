// PNG in and out: round trips, and every way a file can be wrong.
#include "drivers/images/png.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>

#include <fstream>
#include <string>

#include "tests/temporary_folder.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class PngTest : public testing::Test {
 protected:
  /// A picture whose every pixel tells its place.
  static GreyImage16 pattern(int width, int height) {
    GreyImage16 image{width, height, {}};
    for (int i = 0; i < width * height; ++i) image.pixels.push_back(static_cast<std::uint16_t>(i * 257 + 3));
    return image;
  }
  static GreyView16 view(const GreyImage16& image) {
    return {image.pixels.data(), image.width, image.height, image.width};
  }
  static std::vector<std::byte> encoded(const GreyImage16& image) {
    std::vector<std::byte> png;
    EXPECT_TRUE(encode_png_grey16(view(image), png));
    return png;
  }
  static std::string fault(std::span<const std::byte> png) {
    GreyImage16 image;
    const Outcome outcome = PngReader::decode(png, "a.png", image);
    if (outcome) return "read";
    EXPECT_EQ(outcome.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(outcome.error().message.find('\n'), std::string::npos);
    EXPECT_EQ(outcome.error().message.rfind("a.png: ", 0), 0U) << outcome.error().message;
    return outcome.error().message;
  }

  const test::TemporaryFolder made_;
  fs::path folder_ = made_.path();
};

TEST_F(PngTest, WritesAndReadsBackEveryPixel) {
  const GreyImage16 image = pattern(64, 48);
  ASSERT_TRUE(write_png_grey16(folder_ / "a.png", view(image)));
  PngReader reader;
  GreyImage16 back;
  const Outcome outcome = reader.read(folder_ / "a.png", back);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(back.width, 64);
  EXPECT_EQ(back.height, 48);
  EXPECT_EQ(back.pixels, image.pixels);
}

TEST_F(PngTest, HonoursTheStride) {
  const GreyImage16 image = pattern(64, 48);
  std::vector<std::byte> png;
  ASSERT_TRUE(encode_png_grey16({image.pixels.data() + 5, 40, 30, 64}, png));
  GreyImage16 back;
  ASSERT_TRUE(PngReader::decode(png, "a.png", back));
  ASSERT_EQ(back.width, 40);
  for (std::size_t v = 0; v < 30; ++v)
    for (std::size_t u = 0; u < 40; ++u) ASSERT_EQ(back.pixels[v * 40 + u], image.pixels[v * 64 + u + 5]);
}

TEST_F(PngTest, ReusesStorage) {
  ASSERT_TRUE(write_png_grey16(folder_ / "a.png", view(pattern(64, 48))));
  PngReader reader;
  GreyImage16 image;
  ASSERT_TRUE(reader.read(folder_ / "a.png", image));
  const auto* storage = image.pixels.data();
  ASSERT_TRUE(reader.read(folder_ / "a.png", image));
  EXPECT_EQ(image.pixels.data(), storage);
}

TEST_F(PngTest, ReadsInterlacedFiles) {
  const GreyImage16 image = pattern(37, 29);
  std::FILE* file = std::fopen((folder_ / "i.png").c_str(), "wb");
  ASSERT_NE(file, nullptr);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, 37, 29, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_byte> bytes;
  for (const std::uint16_t p : image.pixels) {
    bytes.push_back(static_cast<png_byte>(p >> 8));
    bytes.push_back(static_cast<png_byte>(p & 255));
  }
  std::vector<png_bytep> rows;
  for (std::size_t v = 0; v < 29; ++v) rows.push_back(bytes.data() + v * 37 * 2);
  png_write_info(png, info);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);

  PngReader reader;
  GreyImage16 back;
  const Outcome outcome = reader.read(folder_ / "i.png", back);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(back.pixels, image.pixels);
}

TEST_F(PngTest, CutShortAnywhereIsAnError) {
  const std::vector<std::byte> png = encoded(pattern(40, 30));
  testing::internal::CaptureStderr();
  for (std::size_t length = 0; length < png.size(); ++length)
    EXPECT_NE(fault(std::span(png).first(length)), "read") << length << " of " << png.size();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(fault(std::span(png).first(png.size() / 2)).find("cut short"), std::string::npos);
}

TEST_F(PngTest, AFlippedByteIsAnError) {
  const std::vector<std::byte> png = encoded(pattern(40, 30));
  testing::internal::CaptureStderr();
  for (std::size_t i = 0; i < png.size(); ++i) {
    std::vector<std::byte> damaged = png;
    damaged[i] ^= std::byte{0x10};
    EXPECT_NE(fault(damaged), "read") << "byte " << i << " of " << png.size();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(PngTest, OtherPixelFormatsAreNamed) {
  const std::vector<std::uint8_t> rgb(3 * 40 * 30, 7);
  ASSERT_TRUE(write_png_rgb8(folder_ / "c.png", 40, 30, rgb));
  PngReader reader;
  GreyImage16 image;
  const Outcome outcome = reader.read(folder_ / "c.png", image);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("8-bit colour"), std::string::npos) << outcome.error().message;
}

TEST_F(PngTest, AbsurdSizesAreRefusedBeforeMemoryIsTaken) {
  std::vector<std::byte> png = encoded(pattern(40, 30));
  png[16] = std::byte{0x7f};  // width of 2^31
  EXPECT_NE(fault(png).find("largest"), std::string::npos);
  png = encoded(pattern(40, 30));
  for (std::size_t i = 16; i < 20; ++i) png[i] = std::byte{0};
  EXPECT_NE(fault(png).find("0x30"), std::string::npos);
}

TEST_F(PngTest, WhatIsNoPngIsNamed) {
  PngReader reader;
  GreyImage16 image;
  EXPECT_NE(reader.read(folder_ / "none.png", image).error().message.find("No such file"), std::string::npos);
  EXPECT_NE(reader.read(folder_, image).error().message.find("directory"), std::string::npos);
  // A pipe would be waited for, a file without end be read for ever.
  ASSERT_EQ(mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
  for (const fs::path& path : {folder_ / "pipe.png", fs::path("/dev/zero")})
    EXPECT_NE(reader.read(path, image).error().message.find("no regular file"), std::string::npos);
  EXPECT_FALSE(is_png(folder_ / "pipe"));
  std::ofstream(folder_ / "huge.png") << "x";
  fs::resize_file(folder_ / "huge.png", std::uintmax_t{1} << 40);
  EXPECT_NE(reader.read(folder_ / "huge.png", image).error().message.find("64 MB"), std::string::npos);
  std::ofstream(folder_ / "text.png") << "this is no picture at all, just some text";
  EXPECT_NE(reader.read(folder_ / "text.png", image).error().message.find("not a PNG"), std::string::npos);
  std::ofstream(folder_ / "empty.png").flush();
  EXPECT_NE(reader.read(folder_ / "empty.png", image).error().message.find("empty"), std::string::npos);
}

TEST_F(PngTest, ColourBytesComeBack) {
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 3 * 20 * 10; ++i) rgb.push_back(static_cast<std::uint8_t>(i * 7));
  ASSERT_TRUE(write_png_rgb8(folder_ / "c.png", 20, 10, rgb));
  png_image picture{};
  picture.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&picture, (folder_ / "c.png").c_str()), 0);
  EXPECT_EQ(picture.width, 20U);
  EXPECT_EQ(picture.height, 10U);
  picture.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(picture));
  ASSERT_NE(png_image_finish_read(&picture, nullptr, back.data(), 0, nullptr), 0);
  EXPECT_EQ(back, rgb);
}

TEST_F(PngTest, FailuresToWriteAreTyped) {
  const GreyImage16 image = pattern(40, 30);
  const Outcome outcome = write_png_grey16(folder_ / "no" / "a.png", view(image));
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, ErrorKind::write);
  EXPECT_NE(outcome.error().message.find("a.png"), std::string::npos);
  EXPECT_FALSE(write_png_grey16("/dev/full", view(image)));
  EXPECT_FALSE(write_png_grey16(folder_ / "a.png", {image.pixels.data(), 0, 30, 40}));
  EXPECT_FALSE(write_png_grey16(folder_ / "a.png", {image.pixels.data(), 40, 30, 39}));
  const std::vector<std::uint8_t> few(10);
  EXPECT_FALSE(write_png_rgb8(folder_ / "a.png", 20, 10, few));
}

}  // namespace
}  // namespace pliant
