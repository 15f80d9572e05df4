#include "drivers/openni2/oni_layout.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

namespace pliant {

namespace {

// All numbers are little-endian.
constexpr std::array<unsigned char, 4> kMagic = {'N', 'I', '1', '0'};
constexpr std::size_t kHeaderBytes = 24;            // magic, version (8), latest stamp (8), highest node (4)
constexpr std::uint32_t kRecordMagic = 0x0052494E;  // "NIR"
constexpr std::size_t kRecordBytes = 28;  // magic, type, node, bytes of fields, of payload, undo position (8)
constexpr std::uint32_t kEnd = 11;        // the type of the last record

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::uint32_t number_at(const unsigned char* bytes) {
  return bytes[0] | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}

}  // namespace

Outcome check_oni_layout(const std::filesystem::path& path) {
  const auto bad = [&](std::string_view what) {
    return Error{ErrorKind::bad_input, fmt::format("{}: {}", path.string(), what)};
  };
  std::error_code status;
  if (std::filesystem::is_directory(path, status)) return bad("is a folder, not an .oni recording");
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  if (!file) return bad(std::strerror(errno));  // NOLINT(concurrency-mt-unsafe)
  const std::uint64_t size = std::filesystem::file_size(path, status);
  if (status) return bad(status.message());
  static_cast<void>(size);
  static_cast<void>(number_at);
  static_cast<void>(kHeaderBytes);
  static_cast<void>(kRecordMagic);
  std::array<unsigned char, kRecordBytes> bytes{};
  if (std::fread(bytes.data(), 1, kHeaderBytes, file.get()) != kHeaderBytes ||
      std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    return bad("is not an .oni recording");
  std::uint64_t at = kHeaderBytes;
  for (;;) {
    if (fseeko(file.get(), static_cast<off_t>(at), SEEK_SET) != 0 ||
        std::fread(bytes.data(), 1, kRecordBytes, file.get()) != kRecordBytes)
      return bad(fmt::format("is cut short at byte {}; was the program that recorded it stopped?", at));
    const std::uint64_t fields = number_at(&bytes[12]), payload = number_at(&bytes[16]);
    if (number_at(bytes.data()) != kRecordMagic || fields < kRecordBytes)
      return bad(fmt::format("is damaged at byte {}: no record begins there", at));
    if (fields + payload > size - at)
      return bad(fmt::format("is cut short: the record at byte {} leads beyond the end", at));
    if (number_at(&bytes[4]) == kEnd) return success();
    at += fields + payload;
  }
}

}  // namespace pliant
