#include "drivers/openni2/oni_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
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
constexpr std::uint32_t kFirstProperty = 3, kLastProperty = 6;  // of whole numbers, reals, texts, bytes
constexpr std::uint32_t kIntProperty = 3, kRealProperty = 4;
constexpr std::array<std::uint32_t, 3> kNodeAdded = {2, 12, 13};  // of three versions
constexpr std::uint32_t kHighestNode = 255;                       // the library makes room for all of them
constexpr std::uint32_t kLongestName = 256;                       // with its zero
constexpr std::uint32_t kEnd = 11;                                // the type of the last record

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::uint32_t number_at(const unsigned char* bytes) {
  return bytes[0] | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}

bool is_node_added(std::uint32_t type) {
  return std::find(kNodeAdded.begin(), kNodeAdded.end(), type) != kNodeAdded.end();
}

bool read_number(std::FILE* file, std::uint32_t& number) {
  std::array<unsigned char, 4> bytes{};
  if (std::fread(bytes.data(), 1, bytes.size(), file) != bytes.size()) return false;
  number = number_at(bytes.data());
  return true;
}

/// The fields behind a record's header begin with a name, and a property goes on with the length of its
/// value. The library takes both as they are: letters beyond ASCII in a name end it in a crash.
bool names_are_sound(std::FILE* file, std::uint32_t type, std::uint64_t fields) {
  std::uint32_t length = 0;
  if (!read_number(file, length) || length < 2 || length > kLongestName || kRecordBytes + 4 + length > fields)
    return false;
  for (std::uint32_t i = 0; i < length; ++i) {
    const int c = std::fgetc(file);
    if (i + 1 < length ? c < 0x20 || c >= 0x7f : c != 0) return false;
  }
  if (is_node_added(type)) return true;
  std::uint32_t bytes = 0;
  if (!read_number(file, bytes) || kRecordBytes + 4 + length + 4 + bytes != fields) return false;
  return (type != kIntProperty && type != kRealProperty) || bytes == 8;
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
  return check_oni_layout(file.get(), size, path.string());
}

Outcome check_oni_layout(std::FILE* file, std::uint64_t size, std::string_view name) {
  const auto bad = [&](std::string_view what) {
    return Error{ErrorKind::bad_input, fmt::format("{}: {}", name, what)};
  };
  std::array<unsigned char, kRecordBytes> bytes{};
  if (std::fread(bytes.data(), 1, kHeaderBytes, file) != kHeaderBytes ||
      std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    return bad("is not an .oni recording");
  if (number_at(&bytes[20]) > kHighestNode)
    return bad("is damaged: it speaks of more streams than there can be");
  std::array<bool, kHighestNode + 1> added{};
  std::uint64_t at = kHeaderBytes;
  for (;;) {
    if (fseeko(file, static_cast<off_t>(at), SEEK_SET) != 0 ||
        std::fread(bytes.data(), 1, kRecordBytes, file) != kRecordBytes)
      return bad(fmt::format("is cut short at byte {}; was the program that recorded it stopped?", at));
    const std::uint64_t fields = number_at(&bytes[12]), payload = number_at(&bytes[16]);
    if (number_at(bytes.data()) != kRecordMagic || fields < kRecordBytes)
      return bad(fmt::format("is damaged at byte {}: no record begins there", at));
    if (fields + payload > size - at)
      return bad(fmt::format("is cut short: the record at byte {} leads beyond the end", at));
    const std::uint32_t type = number_at(&bytes[4]);
    if (type == kEnd) return success();
    if (is_node_added(type)) {
      const std::uint32_t node = number_at(&bytes[8]);
      if (node > kHighestNode || added[node])
        return bad(fmt::format("is damaged: the record at byte {} adds a stream that cannot be", at));
      added[node] = true;
    }
    if (((type >= kFirstProperty && type <= kLastProperty) || is_node_added(type)) &&
        !names_are_sound(file, type, fields))
      return bad(fmt::format("is damaged: the record at byte {} holds no sound name and value", at));
    at += fields + payload;
  }
}

}  // namespace pliant
