#include "drivers/openni2/oni_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>

#include "drivers/openni2/little_endian_reads.hpp"
#include "drivers/openni2/oni_records.hpp"

namespace pliant {

namespace {

// All numbers are little-endian.
constexpr std::array<unsigned char, 4> kMagic = {'N', 'I', '1', '0'};
constexpr std::size_t kHeaderBytes = 24;  // magic, version (8), latest stamp (8), highest stream (4)
constexpr std::uint32_t kRecordMagic = 0x0052494E;  // "NIR"
constexpr std::size_t kMostHeader =
    28;  // of a record: magic, type, stream, bytes of fields, of payload, undo

/// The library plays what is no older and no newer.
constexpr std::array<std::uint32_t, 4> kOldest = {1, 0, 0, 4}, kFirstOf64Bits = {1, 0, 1, 0},
                                       kNewest = {1, 0, 1, 0};

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Reads as much of `bytes` as there is from `at` on.
std::span<const unsigned char> read_at(std::FILE* file, std::uint64_t at, std::span<unsigned char> bytes) {
  if (fseeko(file, static_cast<off_t>(at), SEEK_SET) != 0) return {};
  return bytes.first(std::fread(bytes.data(), 1, bytes.size(), file));
}

OniRecord header_of(std::span<const unsigned char> bytes) {
  return {little_endian32(bytes, 4), little_endian32(bytes, 8), little_endian32(bytes, 12),
          little_endian32(bytes, 16)};
}

bool is_seek_table(std::FILE* file, std::uint32_t header_bytes, const OniSeekTable& table) {
  std::array<unsigned char, kMostHeader> bytes{};
  if (read_at(file, table.at, bytes).size() < header_bytes) return false;
  const OniRecord record = header_of(bytes);
  return little_endian32(bytes, 0) == kRecordMagic && record.type == OniRecordType::kSeekTable &&
         record.stream == table.stream && record.fields == header_bytes && record.payload == table.payload;
}

}  // namespace

Outcome check_oni_layout(const std::filesystem::path& path) {
  const auto bad = [&](std::string_view what) {
    return Error{ErrorKind::bad_input, fmt::format("{}: {}", path.string(), what)};
  };
  std::error_code status;
  if (std::filesystem::is_directory(path, status)) return bad("is a folder, not an .oni recording");
  // Of a pipe the first byte may never come.
  if (std::filesystem::is_other(path, status)) return bad("is a device or a pipe, not an .oni recording");
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
  std::array<unsigned char, kMostHeader + OniRecords::kLookedAt> buffer{};
  const std::span<const unsigned char> header = read_at(file, 0, std::span(buffer).first(kHeaderBytes));
  if (header.size() != kHeaderBytes || std::memcmp(header.data(), kMagic.data(), kMagic.size()) != 0)
    return bad("is not an .oni recording");
  const std::array<std::uint32_t, 4> version = {header[4], header[5], little_endian32(header, 4) >> 16,
                                                little_endian32(header, 8)};
  if (version < kOldest || version > kNewest)
    return bad(fmt::format("is damaged, or of a kind that libOpenNI2 does not play: version {}.{}.{}.{}",
                           version[0], version[1], version[2], version[3]));
  if (little_endian32(header, 20) > OniRecords::kHighestStream)
    return bad("is damaged: it speaks of more streams than there can be");
  OniRecords records(version < kFirstOf64Bits, little_endian32(header, 20), little_endian64(header, 12));
  const std::uint32_t header_bytes = records.header_bytes();
  std::uint64_t at = kHeaderBytes;
  for (;;) {
    const std::span<const unsigned char> bytes = read_at(file, at, buffer);
    if (bytes.size() < header_bytes)
      return bad(fmt::format("is cut short at byte {}; was the program that recorded it stopped?", at));
    const OniRecord record = header_of(bytes);
    if (little_endian32(bytes, 0) != kRecordMagic || record.fields < header_bytes)
      return bad(fmt::format("is damaged at byte {}: no record begins there", at));
    const std::uint64_t length = std::uint64_t{record.fields} + record.payload;
    if (length > size - at)
      return bad(fmt::format("is cut short: the record at byte {} leads beyond the end", at));
    const std::size_t there = std::min<std::size_t>(bytes.size(), record.fields);
    if (const std::string_view why = records.take(record, bytes.subspan(header_bytes, there - header_bytes));
        !why.empty())
      return bad(fmt::format("is damaged: the record at byte {} {}", at, why));
    if (const auto table = records.seek_table()) {
      if (table->at > size || header_bytes + table->payload > size - table->at)
        return bad(fmt::format("is cut short: the record at byte {} names a seek table beyond the end", at));
      if (!is_seek_table(file, header_bytes, *table))
        return bad(
            fmt::format("is damaged: the record at byte {} adds a stream whose seek table is not there", at));
    }
    if (record.type == OniRecordType::kEnd)
      return records.data_begun() ? success() : Outcome(bad("holds no picture"));
    at += length;
  }
}

}  // namespace pliant
