// How readings lie in buffers.
#include "drivers/v4l2/v4l2_format.hpp"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <numeric>
#include <vector>

namespace pliant {
namespace {

constexpr std::uint32_t kY12P = v4l2_fourcc('Y', '1', '2', 'P');

std::vector<std::uint16_t> unpack(const V4l2Layout& layout, const std::vector<std::byte>& buffer) {
  std::vector<std::uint16_t> out(std::size_t{layout.width} * layout.height, 0xFFFF);
  v4l2_unpack(layout, buffer, out);
  return out;
}

/// Some reading at each place, of so many bits.
std::uint16_t reading(std::uint32_t u, std::uint32_t v, unsigned bits) {
  return static_cast<std::uint16_t>((u * 2654435761U + v * 40503U + 77) >> 7 & ((1U << bits) - 1));
}

TEST(V4l2Format, WordsAreReadInPlaceAndUnpackedTheSame) {
  const auto layout = v4l2_layout(V4L2_PIX_FMT_Z16, 33, 24, 80, 0);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_EQ(layout->bytes, 80U * 23 + 66) << "the last row needs no padding";
  std::vector<std::byte> buffer(80 * 24);
  for (std::uint32_t v = 0; v < 24; ++v)
    for (std::uint32_t u = 0; u < 33; ++u) {
      buffer[v * 80 + 2 * u] = static_cast<std::byte>(reading(u, v, 16) & 255U);
      buffer[v * 80 + 2 * u + 1] = static_cast<std::byte>(reading(u, v, 16) >> 8);
    }
  const auto in_place = v4l2_readings_in_place(*layout, buffer);
  ASSERT_TRUE(in_place);
  const auto out = unpack(*layout, buffer);
  for (std::uint32_t v = 0; v < 24; ++v)
    for (std::uint32_t u = 0; u < 33; ++u) {
      ASSERT_EQ(out[v * 33 + u], reading(u, v, 16));
      ASSERT_EQ((*in_place)[v * 40 + u], reading(u, v, 16));
    }
  EXPECT_FALSE(v4l2_readings_in_place(*v4l2_layout(V4L2_PIX_FMT_Z16, 33, 24, 67, 0), buffer)) << "odd rows";
}

TEST(V4l2Format, DepthIsTheSecondHalfOfInzi) {
  for (const std::uint32_t bytes_per_line : {64U, 128U, 0U}) {  // drivers say either
    const auto layout = v4l2_layout(V4L2_PIX_FMT_INZI, 32, 24, bytes_per_line, 4 * 32 * 24);
    ASSERT_TRUE(layout) << layout.error().message;
    EXPECT_EQ(layout->begin, 2U * 32 * 24);
    EXPECT_EQ(layout->bytes, 4U * 32 * 24);
    std::vector<std::byte> buffer(4 * 32 * 24, std::byte{0xEE});
    for (std::size_t i = 0; i < std::size_t{32} * 24; ++i)
      buffer[2 * 32 * 24 + 2 * i] = buffer[2 * 32 * 24 + 2 * i + 1] = {};
    buffer[2 * 32 * 24 + 2 * 35] = std::byte{0x34};
    buffer[2 * 32 * 24 + 2 * 35 + 1] = std::byte{0x12};
    const auto out = unpack(*layout, buffer);
    EXPECT_EQ(out[35], 0x1234);
    EXPECT_EQ(std::accumulate(out.begin(), out.end(), 0), 0x1234);
    EXPECT_TRUE(v4l2_readings_in_place(*layout, buffer));
  }
}

TEST(V4l2Format, TwelveBitsArePackedAsMipiDoes) {
  const auto layout = v4l2_layout(kY12P, 34, 24, 60, 60 * 24);
  ASSERT_TRUE(layout) << layout.error().message;
  std::vector<std::byte> buffer(60 * 24, std::byte{0xEE});
  for (std::uint32_t v = 0; v < 24; ++v)
    for (std::uint32_t u = 0; u < 34; u += 2) {
      const unsigned a = reading(u, v, 12), b = reading(u + 1, v, 12);
      std::byte* group = &buffer[v * 60 + u / 2 * 3];
      group[0] = static_cast<std::byte>(a >> 4);
      group[1] = static_cast<std::byte>(b >> 4);
      group[2] = static_cast<std::byte>((a & 15U) | (b & 15U) << 4);
    }
  EXPECT_FALSE(v4l2_readings_in_place(*layout, buffer));
  const auto out = unpack(*layout, buffer);
  for (std::uint32_t v = 0; v < 24; ++v)
    for (std::uint32_t u = 0; u < 34; ++u) ASSERT_EQ(out[v * 34 + u], reading(u, v, 12)) << u << ' ' << v;
}

TEST(V4l2Format, TenBitsFollowEachOther) {
  constexpr std::uint32_t kWidth = 37;  // no whole number of groups
  const auto layout = v4l2_layout(V4L2_PIX_FMT_Y10BPACK, kWidth, 24, 0, 0);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_EQ(layout->row_bytes, 47U);
  std::vector<std::byte> buffer(layout->bytes);
  for (std::uint32_t v = 0; v < 24; ++v)
    for (std::uint32_t u = 0; u < kWidth; ++u)
      for (unsigned bit = 0; bit < 10; ++bit) {
        const unsigned at = u * 10 + bit;
        if ((reading(u, v, 10) >> (9 - bit) & 1U) != 0)
          buffer[v * 47 + at / 8] |= static_cast<std::byte>(128U >> (at % 8));
      }
  const auto out = unpack(*layout, buffer);
  for (std::uint32_t v = 0; v < 24; ++v)
    for (std::uint32_t u = 0; u < kWidth; ++u)
      ASSERT_EQ(out[v * kWidth + u], reading(u, v, 10)) << u << ' ' << v;
}

TEST(V4l2Format, NumbersThatCannotBeTrueAreRefused) {
  EXPECT_FALSE(v4l2_layout(V4L2_PIX_FMT_YUYV, 640, 480, 1280, 0));
  EXPECT_FALSE(v4l2_layout(V4L2_PIX_FMT_Z16, 640, 480, 1278, 0)) << "a row too short";
  EXPECT_FALSE(v4l2_layout(V4L2_PIX_FMT_Z16, 640, 480, 1280, 614'399)) << "a frame too short";
  EXPECT_FALSE(v4l2_layout(V4L2_PIX_FMT_Z16, 640, 480, 0x80000000U, 0));
  EXPECT_FALSE(v4l2_layout(V4L2_PIX_FMT_Z16, 0, 0, 0, 0));
  EXPECT_FALSE(v4l2_layout(V4L2_PIX_FMT_Z16, 0xFFFFFFFFU, 0xFFFFFFFFU, 0, 0));
  EXPECT_TRUE(v4l2_layout(V4L2_PIX_FMT_Z16, 640, 480, 1280, 614'400));
}

TEST(V4l2Format, NamesAreShown) {
  EXPECT_EQ(fourcc_text(V4L2_PIX_FMT_Z16), "Z16");
  EXPECT_EQ(fourcc_text(V4L2_PIX_FMT_YUYV), "YUYV");
  EXPECT_EQ(fourcc_text(1), "????");
  EXPECT_EQ(find_v4l2_format("INZI")->code, V4L2_PIX_FMT_INZI);
  EXPECT_EQ(find_v4l2_format("YUYV"), nullptr);
}

}  // namespace
}  // namespace pliant
