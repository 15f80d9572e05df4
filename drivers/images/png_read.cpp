#include <fmt/core.h>
#include <png.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>

#include "core/limits.hpp"
#include "drivers/images/png.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20;
constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 20;  ///< of anything but picture data, unpacked
constexpr std::size_t kHeaderBytes = 33;                      ///< signature and the whole IHDR chunk

Error bad(std::string_view name, std::string_view what) {
  return {ErrorKind::bad_input, fmt::format("{}: {}", name, what)};
}

/// All that libpng's callbacks touch. libpng leaves by longjmp, so nothing between setjmp and the calls owns
/// anything.
struct Decoder {
  std::span<const std::byte> data;
  std::size_t position = 0;
  std::array<char, 128> fault{};
  png_structp png = nullptr;
  png_infop info = nullptr;

  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto* decoder = static_cast<Decoder*>(png_get_error_ptr(png));
  std::snprintf(decoder->fault.data(), decoder->fault.size(), "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void on_read(png_structp png, png_bytep to, png_size_t count) {
  auto* decoder = static_cast<Decoder*>(png_get_io_ptr(png));
  if (count > decoder->data.size() - decoder->position) png_error(png, "cut short");
  std::memcpy(to, decoder->data.data() + decoder->position, count);
  decoder->position += count;
}

/// False with decoder.fault set. The size was read from the header before; libpng reads the same bytes.
bool decode_rows(Decoder& decoder, std::uint16_t* pixels, std::size_t width, std::size_t height) {
  decoder.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, on_error, on_warning);
  if (decoder.png != nullptr) decoder.info = png_create_info_struct(decoder.png);
  if (decoder.info == nullptr) {
    std::snprintf(decoder.fault.data(), decoder.fault.size(), "out of memory");
    return false;
  }
  if (setjmp(png_jmpbuf(decoder.png)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's own way
  png_set_read_fn(decoder.png, &decoder, on_read);
  png_set_user_limits(decoder.png, limits::kMaxFrameWidth, limits::kMaxFrameHeight);
  png_set_chunk_malloc_max(decoder.png, kMaxChunkBytes);
  png_set_chunk_cache_max(decoder.png, 16);
  png_read_info(decoder.png, decoder.info);
  if (std::endian::native == std::endian::little) png_set_swap(decoder.png);
  const int passes = png_set_interlace_handling(decoder.png);
  png_read_update_info(decoder.png, decoder.info);
  if (png_get_rowbytes(decoder.png, decoder.info) != width * sizeof(std::uint16_t))
    png_error(decoder.png, "unexpected row size");
  for (int pass = 0; pass < passes; ++pass)
    for (std::size_t v = 0; v < height; ++v)
      png_read_row(decoder.png, static_cast<png_bytep>(static_cast<void*>(pixels + v * width)), nullptr);
  png_read_end(decoder.png, nullptr);
  return true;
}

std::uint32_t big_endian32(const std::byte* p) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(p[i]);
  return value;
}

Error too_large(const std::filesystem::path& file) {
  return bad(file.string(), "larger than 64 MB; not a depth picture");
}

/// Reads the whole file into `data`, whose storage is reused.
Outcome load(const std::filesystem::path& file, std::vector<std::byte>& data) {
  // Opening a pipe would wait for its writer, for ever.
  struct stat about {};
  if (::stat(file.c_str(), &about) != 0) return bad(file.string(), std::strerror(errno));
  if (!S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode))
    return bad(file.string(), "is no regular file; not a depth picture");
  if (static_cast<std::uintmax_t>(about.st_size) > kMaxFileBytes) return too_large(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!in) return bad(file.string(), std::strerror(errno));
  data.resize(std::max(data.capacity(), std::size_t{1} << 16));
  std::size_t size = 0;
  for (;;) {
    errno = 0;
    size += std::fread(data.data() + size, 1, data.size() - size, in.get());
    if (std::ferror(in.get()) != 0) return bad(file.string(), std::strerror(errno));
    if (size < data.size()) break;
    if (size > kMaxFileBytes) return too_large(file);
    data.resize(2 * data.size());
  }
  data.resize(size);
  return success();
}

}  // namespace

bool is_png(const std::filesystem::path& file) {
  std::array<char, 4> start{};
  std::error_code ignored;
  if (std::filesystem::is_fifo(file, ignored)) return file.extension() == ".png";
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), start.size());
  return file.extension() == ".png" || (stream && start == std::array<char, 4>{'\x89', 'P', 'N', 'G'});
}

Outcome PngReader::read(const std::filesystem::path& file, GreyImage16& image) {
  if (Outcome loaded = load(file, data_); !loaded) return loaded;
  return decode(data_, file.string(), image);
}

Outcome PngReader::decode(std::span<const std::byte> data, std::string_view name, GreyImage16& image) {
  static constexpr std::array<unsigned char, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (data.empty()) return bad(name, "empty file");
  const std::size_t known = std::min(data.size(), kSignature.size());
  if (std::memcmp(data.data(), kSignature.data(), known) != 0) return bad(name, "not a PNG file");
  if (data.size() < kHeaderBytes) return bad(name, "PNG is cut short");
  if (std::memcmp(data.data() + 12, "IHDR", 4) != 0) return bad(name, "PNG without a header");

  const std::uint32_t width = big_endian32(data.data() + 16);
  const std::uint32_t height = big_endian32(data.data() + 20);
  const int bits = std::to_integer<int>(data[24]);
  const int colour_type = std::to_integer<int>(data[25]);
  if (colour_type != PNG_COLOR_TYPE_GRAY || bits != 16)
    return bad(name, fmt::format("PNG holds {}-bit {}; a depth picture is 16-bit grey", bits,
                                 colour_type == PNG_COLOR_TYPE_GRAY ? "grey" : "colour or alpha"));
  if (width < 1 || width > limits::kMaxFrameWidth || height < 1 || height > limits::kMaxFrameHeight)
    return bad(name, fmt::format("PNG of {}x{} pixels; the largest that is read is {}x{}", width, height,
                                 limits::kMaxFrameWidth, limits::kMaxFrameHeight));
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.pixels.resize(std::size_t{width} * height);

  Decoder decoder;
  decoder.data = data;
  if (!decode_rows(decoder, image.pixels.data(), width, height))
    return bad(name, fmt::format("PNG is damaged ({})", decoder.fault.data()));
  return success();
}

}  // namespace pliant
