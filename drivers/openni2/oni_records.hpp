// What libOniFile takes from the records of an .oni recording without looking, looked at before it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace pliant {

/// A record's header.
struct OniRecord {
  std::uint32_t type = 0, stream = 0;
  std::uint32_t fields = 0;   ///< bytes, the header's own among them
  std::uint32_t payload = 0;  ///< bytes behind the fields
};

/// Numbers of OpenNI2 2.2.0.33, Source/Drivers/OniFile: DataRecords.h, PlayerNode.cpp, XnPlayerTypes.h.
struct OniRecordType {
  static constexpr std::uint32_t kStreamAdded4 = 2, kInt = 3, kReal = 4, kText = 5, kBytes = 6,
                                 kStreamRemoved = 7, kDataBegins = 8, kStreamReady = 9, kPicture = 10,
                                 kEnd = 11, kStreamAdded5 = 12, kStreamAdded = 13, kSeekTable = 14;
};

/// Where a stream's seek table should be.
struct OniSeekTable {
  std::uint64_t at = 0;
  std::uint32_t stream = 0, payload = 0;
};

/// Keeps what the library would know after each record. The library goes on after a record that it refuses,
/// without skipping its payload, calls decoders that were never made, and divides by sizes that were never
/// set; so a file is sound only when no record gives it reason to.
class OniRecords {
 public:
  static constexpr std::uint32_t kHighestStream = 255;  ///< the library makes room for all of them
  /// Fields that must be given to take(): a name and a short value.
  static constexpr std::size_t kLookedAt = 4 + 256 + 4 + 32;

  /// `old_headers`: the file's format is older than 1.0.1.0, whose positions have 32 bits.
  OniRecords(bool old_headers, std::uint32_t highest_stream, std::uint64_t latest_stamp)
      : old_(old_headers), highest_(highest_stream), latest_stamp_(latest_stamp) {}
  [[nodiscard]] std::uint32_t header_bytes() const noexcept { return old_ ? 24 : 28; }

  /// Why the next record is not sound; empty where it is. `content`: its fields behind the header, the first
  /// kLookedAt bytes at most.
  [[nodiscard]] std::string_view take(const OniRecord& record, std::span<const unsigned char> content);
  /// Of the stream that the latest record added, if it has one.
  [[nodiscard]] std::optional<OniSeekTable> seek_table() const noexcept { return seek_table_; }
  /// Pictures were announced.
  [[nodiscard]] bool data_begun() const noexcept { return data_begun_; }

 private:
  struct Stream {
    bool added = false, ready = false, pictures = false, has_size = false;
    std::uint32_t frames = 0;
  };
  [[nodiscard]] std::string_view add_stream(const OniRecord& record, std::span<const unsigned char> content);
  [[nodiscard]] std::string_view set_property(const OniRecord& record,
                                              std::span<const unsigned char> content);
  [[nodiscard]] std::string_view take_picture(const OniRecord& record,
                                              std::span<const unsigned char> content) const;
  [[nodiscard]] Stream* stream(std::uint32_t number);

  const bool old_;
  const std::uint32_t highest_;
  const std::uint64_t latest_stamp_;
  std::array<Stream, kHighestStream + 1> streams_{};
  std::optional<OniSeekTable> seek_table_;
  bool data_begun_ = false;
};

}  // namespace pliant
