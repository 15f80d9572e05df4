// Writes MCAP files by the public specification (mcap.dev/spec), version 0: chunks without compression, with
// message indices, chunk indices, statistics and checksums.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"
#include "drivers/geometry_files/atomic_file.hpp"

namespace pliant {

class McapWriter {
 public:
  /// Makes or replaces the file, which appears when it is finished. Every failure is an ErrorKind::write.
  [[nodiscard]] static Result<McapWriter> create(const std::string& path, std::string_view library);

  /// All schemas and channels are announced before the first message. Returns the new one's number.
  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view text);
  std::uint16_t add_channel(std::string_view topic, std::uint16_t schema, std::string_view encoding);

  /// Times in nanoseconds since the epoch.
  [[nodiscard]] Outcome write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                              std::string_view data);
  /// The summary and the footer; the file is whole only then.
  [[nodiscard]] Outcome finish();

 private:
  struct ChunkIndex {
    std::uint64_t first_time = 0, last_time = 0, offset = 0, bytes = 0, index_bytes = 0, content_bytes = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
  };
  struct IndexEntry {
    std::uint64_t time = 0, offset = 0;
  };

  [[nodiscard]] Outcome put(std::string_view bytes);
  [[nodiscard]] Outcome end_chunk();

  std::unique_ptr<AtomicFile> file_;
  std::uint64_t at_ = 0;                         // bytes written
  std::uint32_t crc_ = 0;                        // of them
  std::vector<std::string> schemas_, channels_;  // their records
  std::string chunk_;                            // records of the chunk that is being filled
  std::uint64_t chunk_first_ = 0, chunk_last_ = 0;
  std::map<std::uint16_t, std::vector<IndexEntry>> chunk_messages_;
  std::vector<ChunkIndex> chunks_;
  std::map<std::uint16_t, std::uint64_t> message_counts_;
  std::uint64_t messages_ = 0, first_time_ = 0, last_time_ = 0;
};

/// The checksum of MCAP, PNG and zlib, over `bytes` after those that gave `before`.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

}  // namespace pliant
