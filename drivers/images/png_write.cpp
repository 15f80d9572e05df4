#include <fmt/core.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <string>

#include "drivers/geometry_files/atomic_file.hpp"
#include "drivers/images/png.hpp"

namespace pliant {

namespace {

Error failed(std::string message) {
  return {ErrorKind::write, std::move(message)};
}

/// What is written: rows of `row_bytes`, `row_step` bytes apart.
struct Rows {
  const unsigned char* first = nullptr;
  std::size_t row_step = 0;
  int width = 0;
  int height = 0;
  int bits = 0;
  int colour_type = 0;
};

/// All that libpng's callbacks touch; see the reader for why nothing else may own anything.
struct Encoder {
  std::vector<std::byte>* out = nullptr;
  std::array<char, 128> fault{};
  png_structp png = nullptr;
  png_infop info = nullptr;

  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { png_destroy_write_struct(&png, &info); }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto* encoder = static_cast<Encoder*>(png_get_error_ptr(png));
  std::snprintf(encoder->fault.data(), encoder->fault.size(), "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

bool append(std::vector<std::byte>& out, const png_byte* bytes, std::size_t count) noexcept {
  try {
    const auto* first = static_cast<const std::byte*>(static_cast<const void*>(bytes));
    out.insert(out.end(), first, first + count);
    return true;
  } catch (...) {  // out of memory; must not pass through libpng's frames
    return false;
  }
}

void on_write(png_structp png, png_bytep bytes, png_size_t count) {
  if (!append(*static_cast<Encoder*>(png_get_io_ptr(png))->out, bytes, count))
    png_error(png, "out of memory");
}

void on_flush(png_structp /*png*/) {}

bool encode_rows(Encoder& encoder, const Rows& rows) {
  encoder.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, on_error, on_warning);
  if (encoder.png != nullptr) encoder.info = png_create_info_struct(encoder.png);
  if (encoder.info == nullptr) {
    std::snprintf(encoder.fault.data(), encoder.fault.size(), "out of memory");
    return false;
  }
  if (setjmp(png_jmpbuf(encoder.png)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's own way
  png_set_write_fn(encoder.png, &encoder, on_write, on_flush);
  png_set_IHDR(encoder.png, encoder.info, static_cast<png_uint_32>(rows.width),
               static_cast<png_uint_32>(rows.height), rows.bits, rows.colour_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  // A fixed filter and quick compression: a recording must keep the sensor's pace. Depth comes in steps that
  // repeat along the row; left as it is it packs as well as by differences, in two thirds of the time.
  const bool depth = rows.bits == 16;
  png_set_compression_level(encoder.png, depth ? 1 : 2);
  png_set_filter(encoder.png, PNG_FILTER_TYPE_BASE, depth ? PNG_FILTER_NONE : PNG_FILTER_SUB);
  png_write_info(encoder.png, encoder.info);
  if (rows.bits == 16 && std::endian::native == std::endian::little) png_set_swap(encoder.png);
  for (int v = 0; v < rows.height; ++v)
    png_write_row(encoder.png, rows.first + static_cast<std::size_t>(v) * rows.row_step);
  png_write_end(encoder.png, nullptr);
  return true;
}

Outcome encode(const Rows& rows, std::vector<std::byte>& png) {
  png.clear();
  if (rows.first == nullptr || rows.width < 1 || rows.height < 1 || rows.width > 32767 || rows.height > 32767)
    return failed(fmt::format("a picture of {}x{} pixels cannot be written as PNG", rows.width, rows.height));
  Encoder encoder;
  encoder.out = &png;
  if (!encode_rows(encoder, rows)) return failed(fmt::format("PNG: {}", encoder.fault.data()));
  return success();
}

}  // namespace

Outcome encode_png_grey16(const GreyView16& image, std::vector<std::byte>& png) {
  Rows rows{nullptr, 0, image.width, image.height, 16, PNG_COLOR_TYPE_GRAY};
  if (image.stride >= image.width && image.stride > 0) {
    rows.first = static_cast<const unsigned char*>(static_cast<const void*>(image.pixels));
    rows.row_step = static_cast<std::size_t>(image.stride) * sizeof(std::uint16_t);
  }
  return encode(rows, png);
}

Outcome write_png_grey16(const std::filesystem::path& file, const GreyView16& image,
                         std::vector<std::byte>& scratch) {
  if (Outcome encoded = encode_png_grey16(image, scratch); !encoded) return encoded;
  return write_whole_file(file.c_str(), scratch, false);
}

Outcome write_png_grey16(const std::filesystem::path& file, const GreyView16& image) {
  std::vector<std::byte> scratch;
  return write_png_grey16(file, image, scratch);
}

Outcome write_png_rgb8(const std::filesystem::path& file, int width, int height,
                       std::span<const std::uint8_t> rgb) {
  Rows rows{nullptr, 0, width, height, 8, PNG_COLOR_TYPE_RGB};
  const auto pixels =
      static_cast<std::size_t>(std::max(width, 0)) * static_cast<std::size_t>(std::max(height, 0));
  if (rgb.size() == 3 * pixels) {
    rows.first = rgb.data();
    rows.row_step = 3 * static_cast<std::size_t>(std::max(width, 0));
  }
  std::vector<std::byte> png;
  if (Outcome encoded = encode(rows, png); !encoded) return encoded;
  return write_whole_file(file.c_str(), png, false);
}

}  // namespace pliant
