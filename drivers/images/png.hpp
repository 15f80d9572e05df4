// PNG pictures: 16-bit grey depth in and out, 8-bit colour out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

/// A 16-bit grey picture, rows from the top, no gaps. Reading into the same object again reuses its storage.
struct GreyImage16 {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  std::vector<std::uint16_t> pixels;
};

/// Pixels to be written: `pixels[v * stride + u]`, borrowed.
struct GreyView16 {
  const std::uint16_t* pixels = nullptr;
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  int stride = 0;  ///< pixels from one row to the next
};

/// Does the file begin as PNG files do, or is its name that of one?
[[nodiscard]] bool is_png(const std::filesystem::path& file);

/// Reads PNG files, keeping its buffers from one file to the next.
///
/// Only 16-bit grey without alpha, at most limits::kMaxFrameWidth × kMaxFrameHeight; anything else, a file
/// cut short or a checksum that does not fit is an ErrorKind::bad_input that names the file and the fault,
/// and leaves the image's content undefined.
class PngReader {
 public:
  [[nodiscard]] Outcome read(const std::filesystem::path& file, GreyImage16& image);
  /// From memory; `name` stands in the errors.
  [[nodiscard]] static Outcome decode(std::span<const std::byte> data, std::string_view name,
                                      GreyImage16& image);

 private:
  std::vector<std::byte> data_;
};

/// `png` becomes the file's bytes, in its old storage. ErrorKind::write when the size is unusable.
[[nodiscard]] Outcome encode_png_grey16(const GreyView16& image, std::vector<std::byte>& png);
/// Writes a 16-bit grey PNG, which appears once it is whole; ErrorKind::write with the file and the reason.
/// `scratch` keeps its storage for the next picture.
[[nodiscard]] Outcome write_png_grey16(const std::filesystem::path& file, const GreyView16& image,
                                       std::vector<std::byte>& scratch);
[[nodiscard]] Outcome write_png_grey16(const std::filesystem::path& file, const GreyView16& image);
/// Likewise an 8-bit colour PNG, from `rgb` (3 · width · height bytes, rows from the top).
[[nodiscard]] Outcome write_png_rgb8(const std::filesystem::path& file, int width, int height,
                                     std::span<const std::uint8_t> rgb);

}  // namespace pliant
