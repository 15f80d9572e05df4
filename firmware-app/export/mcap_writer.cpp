#include "firmware-app/export/mcap_writer.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace pliant {

namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = 4U << 20;

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F
};

/// Little-endian fields, one after the other.
class Fields {
 public:
  Fields& u8(std::uint8_t value) { return number(value, 1); }
  Fields& u16(std::uint16_t value) { return number(value, 2); }
  Fields& u32(std::uint32_t value) { return number(value, 4); }
  Fields& u64(std::uint64_t value) { return number(value, 8); }
  Fields& text(std::string_view value) {
    u32(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  Fields& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] std::string record(Op op) const {
    Fields out;
    out.u8(static_cast<std::uint8_t>(op)).u64(bytes_.size()).raw(bytes_);
    return out.bytes_;
  }

 private:
  Fields& number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xFF);
    return *this;
  }
  std::string bytes_;
};

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1U) != 0 ? 0xEDB88320U : 0U);
      table[i] = value;
    }
    return table;
  }();
  std::uint32_t crc = ~before;
  for (const char c : bytes) crc = kTable[(crc ^ static_cast<std::uint8_t>(c)) & 0xFFU] ^ (crc >> 8);
  return ~crc;
}

Result<McapWriter> McapWriter::create(const std::string& path, std::string_view library) {
  McapWriter writer;
  writer.file_ = std::make_unique<AtomicFile>();
  if (Outcome opened = writer.file_->open(path.c_str()); !opened) return opened.error();
  if (Outcome put = writer.put(kMagic); !put) return put.error();
  if (Outcome put = writer.put(Fields().text("").text(library).record(Op::header)); !put) return put.error();
  return writer;
}

Outcome McapWriter::put(std::string_view bytes) {
  if (Outcome written = file_->write(std::as_bytes(std::span(bytes))); !written) return written;
  at_ += bytes.size();
  crc_ = crc32(bytes, crc_);
  return success();
}

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view encoding,
                                     std::string_view text) {
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);  // 0 stands for no schema
  schemas_.push_back(Fields().u16(id).text(name).text(encoding).text(text).record(Op::schema));
  chunk_ += schemas_.back();
  return id;
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::uint16_t schema,
                                      std::string_view encoding) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_.push_back(Fields().u16(id).u16(schema).text(topic).text(encoding).u32(0).record(Op::channel));
  chunk_ += channels_.back();
  return id;
}

Outcome McapWriter::write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                          std::string_view data) {
  const bool first = chunk_messages_.empty();
  chunk_first_ = first ? log_time : std::min(chunk_first_, log_time);
  chunk_last_ = first ? log_time : std::max(chunk_last_, log_time);
  first_time_ = messages_ == 0 ? log_time : std::min(first_time_, log_time);
  last_time_ = messages_ == 0 ? log_time : std::max(last_time_, log_time);
  ++messages_;
  chunk_messages_[channel].push_back({log_time, chunk_.size()});
  const auto sequence = static_cast<std::uint32_t>(++message_counts_[channel]);
  chunk_ += Fields().u16(channel).u32(sequence).u64(log_time).u64(publish_time).raw(data).record(Op::message);
  return chunk_.size() >= kChunkBytes ? end_chunk() : success();
}

Outcome McapWriter::end_chunk() {
  ChunkIndex index;
  index.first_time = chunk_first_;
  index.last_time = chunk_last_;
  index.offset = at_;
  index.content_bytes = chunk_.size();
  if (Outcome done = put(Fields()
                             .u64(chunk_first_)
                             .u64(chunk_last_)
                             .u64(chunk_.size())
                             .u32(crc32(chunk_))
                             .text("")
                             .u64(chunk_.size())
                             .raw(chunk_)
                             .record(Op::chunk));
      !done)
    return done;
  index.bytes = at_ - index.offset;
  for (const auto& [channel, entries] : chunk_messages_) {
    index.index_offsets[channel] = at_;
    Fields list;
    for (const IndexEntry& entry : entries) list.u64(entry.time).u64(entry.offset);
    if (Outcome done = put(Fields().u16(channel).text(list.bytes()).record(Op::message_index)); !done)
      return done;
  }
  index.index_bytes = at_ - index.offset - index.bytes;
  chunks_.push_back(std::move(index));
  chunk_.clear();
  chunk_messages_.clear();
  return success();
}

Outcome McapWriter::finish() {
  if (!chunk_.empty())
    if (Outcome done = end_chunk(); !done) return done;
  if (Outcome done = put(Fields().u32(crc_).record(Op::data_end)); !done) return done;

  std::string summary, offsets;
  const std::uint64_t summary_at = at_;
  const auto add_group = [&](Op op, const std::vector<std::string>& records) {
    const std::size_t begin = summary.size();
    for (const std::string& record : records) summary += record;
    if (summary.size() == begin) return;
    offsets += Fields()
                   .u8(static_cast<std::uint8_t>(op))
                   .u64(summary_at + begin)
                   .u64(summary.size() - begin)
                   .record(Op::summary_offset);
  };
  add_group(Op::schema, schemas_);
  add_group(Op::channel, channels_);
  Fields counts;
  for (const auto& [channel, count] : message_counts_) counts.u16(channel).u64(count);
  add_group(Op::statistics, {Fields()
                                 .u64(messages_)
                                 .u16(static_cast<std::uint16_t>(schemas_.size()))
                                 .u32(static_cast<std::uint32_t>(channels_.size()))
                                 .u32(0)
                                 .u32(0)
                                 .u32(static_cast<std::uint32_t>(chunks_.size()))
                                 .u64(first_time_)
                                 .u64(last_time_)
                                 .text(counts.bytes())
                                 .record(Op::statistics)});
  std::vector<std::string> indices;
  for (const ChunkIndex& chunk : chunks_) {
    Fields by_channel;
    for (const auto& [channel, offset] : chunk.index_offsets) by_channel.u16(channel).u64(offset);
    indices.push_back(Fields()
                          .u64(chunk.first_time)
                          .u64(chunk.last_time)
                          .u64(chunk.offset)
                          .u64(chunk.bytes)
                          .text(by_channel.bytes())
                          .u64(chunk.index_bytes)
                          .text("")
                          .u64(chunk.content_bytes)
                          .u64(chunk.content_bytes)
                          .record(Op::chunk_index));
  }
  add_group(Op::chunk_index, indices);

  // The summary's checksum covers the footer up to itself.
  Fields footer;
  footer.u64(summary_at).u64(summary_at + summary.size());
  const std::string start =
      Fields().u8(static_cast<std::uint8_t>(Op::footer)).u64(footer.bytes().size() + 4).bytes() +
      footer.bytes();
  const std::string all = summary + offsets + start;
  if (Outcome done = put(all + Fields().u32(crc32(all)).bytes()); !done) return done;
  if (Outcome done = put(kMagic); !done) return done;
  return file_->commit(false);
}

}  // namespace pliant
