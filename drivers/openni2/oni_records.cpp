#include "drivers/openni2/oni_records.hpp"

#include <algorithm>

#include "drivers/openni2/little_endian_reads.hpp"

namespace pliant {

namespace {

using Content = std::span<const unsigned char>;
using Type = OniRecordType;

constexpr std::uint32_t kLongestName = 256;  // with its zero
constexpr std::uint32_t kLargestPicture = 1600 * 1200 * 3;
constexpr std::uint32_t kPictureFields = 12;                                     // stamp and frame number
constexpr std::uint32_t kLargestRecord = 28 + kPictureFields + kLargestPicture;  // of the library's buffer
constexpr std::uint32_t kLongestSide = 8192;                                     // pixels
constexpr std::array<std::uint32_t, 3> kPictureStreams = {2, 3, 5};              // depth, colour, infrared
constexpr std::uint32_t code(char a, char b, char c, char d) {
  const auto byte = [](char letter) { return std::uint32_t{static_cast<unsigned char>(letter)}; };
  return byte(a) | byte(b) << 8 | byte(c) << 16 | byte(d) << 24;
}
constexpr std::array<std::uint32_t, 5> kCodecs = {code('N', 'O', 'N', 'E'), code('J', 'P', 'E', 'G'),
                                                  code('1', '6', 'z', 'P'), code('1', '6', 'z', 'T'),
                                                  code('I', 'm', '8', 'z')};

constexpr std::string_view kNoName = "holds no sound name and value";
constexpr std::string_view kNoStream = "is of a stream that is not there";

/// A name with its length before it and a zero behind; the bytes it takes, 0 where it is none. Letters beyond
/// ASCII would end the library in a crash.
std::uint32_t name_at_front(Content content, std::string_view& name) {
  if (content.size() < 4) return 0;
  const std::uint32_t length = little_endian32(content, 0);
  if (length < 2 || length > kLongestName || 4 + length > content.size()) return 0;
  const Content letters = content.subspan(4, length);
  if (letters.back() != 0) return 0;
  if (std::any_of(letters.begin(), letters.end() - 1, [](unsigned char c) { return c < 0x20 || c >= 0x7f; }))
    return 0;
  const void* first = letters.data();
  name = {static_cast<const char*>(first), length - 1};
  return 4 + length;
}

template <std::size_t N>
bool is_one_of(std::uint32_t value, const std::array<std::uint32_t, N>& values) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

}  // namespace

OniRecords::Stream* OniRecords::stream(std::uint32_t number) {
  if (number > highest_ || number > kHighestStream || !streams_[number].added) return nullptr;
  return &streams_[number];
}

std::string_view OniRecords::take(const OniRecord& record, Content content) {
  seek_table_.reset();
  if (record.fields > kLargestRecord || record.payload > kLargestRecord - record.fields)
    return "is larger than a record can be";
  const bool has_payload = record.type == Type::kPicture || record.type == Type::kSeekTable;
  if (!has_payload && record.payload != 0) return "has a payload where there is none";
  Stream* const known = stream(record.stream);
  switch (record.type) {
    case Type::kStreamAdded4:
    case Type::kStreamAdded5:
    case Type::kStreamAdded:
      return add_stream(record, content);
    case Type::kInt:
    case Type::kReal:
    case Type::kText:
    case Type::kBytes:
      return set_property(record, content);
    case Type::kStreamRemoved:
      if (known == nullptr) return kNoStream;
      *known = {};
      return {};
    case Type::kDataBegins:
      if (known == nullptr || !known->pictures) return kNoStream;
      data_begun_ = true;
      return {};
    case Type::kStreamReady:
      if (known == nullptr) return kNoStream;
      if (known->pictures && !known->has_size) return "is of a stream without a size";
      known->ready = true;
      return {};
    case Type::kPicture:
      return take_picture(record, content);
    case Type::kSeekTable:
      return record.stream > highest_ ? kNoStream : std::string_view();
    case Type::kEnd:
      return {};
    default:
      return "is of no known kind";
  }
}

std::string_view OniRecords::add_stream(const OniRecord& record, Content content) {
  constexpr std::string_view kCannotBe = "adds a stream that cannot be";
  if (record.stream > highest_ || record.stream > kHighestStream || streams_[record.stream].added)
    return kCannotBe;
  std::string_view name;
  const std::uint32_t begin = name_at_front(content, name);
  if (begin == 0) return kNoName;
  // Its kind and codec; from 1.0.0.5 on the frames and their stamps; then the seek table's place.
  const bool counts = record.type != Type::kStreamAdded4, seeks = record.type == Type::kStreamAdded;
  const std::uint32_t bytes = 8 + (counts ? 20U : 0U) + (seeks ? (old_ ? 4U : 8U) : 0U);
  if (record.fields != header_bytes() + begin + bytes || content.size() < begin + bytes) return kNoName;
  Stream added;
  added.added = true;
  added.pictures = is_one_of(little_endian32(content, begin), kPictureStreams);
  if (added.pictures && !is_one_of(little_endian32(content, begin + 4), kCodecs)) return kCannotBe;
  // What is older tells its frames elsewhere: no picture's number is too high.
  added.frames = counts ? little_endian32(content, begin + 8) : ~std::uint32_t{0};
  streams_[record.stream] = added;
  if (!seeks || added.frames == 0) return {};
  const std::uint64_t place =
      old_ ? little_endian32(content, begin + 28) : little_endian64(content, begin + 28);
  if (place == 0) return {};
  const std::uint32_t entry = old_ ? 16 : 20;
  if (added.frames >= kLargestRecord / entry) return "adds a stream of too many frames";
  seek_table_ = OniSeekTable{place, record.stream, (added.frames + 1) * entry};
  return {};
}

std::string_view OniRecords::set_property(const OniRecord& record, Content content) {
  Stream* const known = stream(record.stream);
  if (known == nullptr) return kNoStream;
  std::string_view name;
  const std::uint32_t begin = name_at_front(content, name);
  if (begin == 0 || content.size() < begin + 4) return kNoName;
  const std::uint32_t bytes = little_endian32(content, begin);
  if (record.fields - header_bytes() - begin - 4 != bytes) return kNoName;
  const Content value = content.subspan(begin + 4);
  const bool number = record.type == Type::kInt || record.type == Type::kReal;
  if (number && (bytes != 8 || value.size() < 8)) return kNoName;
  // A text is read up to its zero.
  if (record.type == Type::kText && (bytes == 0 || (bytes <= value.size() && value[bytes - 1] != 0)))
    return kNoName;
  if (record.type == Type::kInt && (name == "oniRequiredFrameSize" || name == "RequiredDataSize")) {
    const std::uint64_t size = little_endian64(value, 0);
    if (size == 0 || size > kLargestPicture) return "wants pictures of a size that cannot be";
  }
  if (record.type == Type::kBytes && name == "xnMapOutputMode") {
    if (bytes != 12 || value.size() < 12) return kNoName;
    const std::uint32_t width = little_endian32(value, 0), height = little_endian32(value, 4);
    if (width == 0 || width > kLongestSide || height == 0 || height > kLongestSide)
      return "wants pictures of a size that cannot be";
    known->has_size = true;
  }
  return {};
}

std::string_view OniRecords::take_picture(const OniRecord& record, Content content) const {
  if (record.stream > highest_ || record.stream > kHighestStream) return kNoStream;
  const Stream& known = streams_[record.stream];
  if (!known.added || !known.pictures || !known.ready) return kNoStream;
  if (record.fields != header_bytes() + kPictureFields || content.size() < kPictureFields ||
      record.payload == 0)
    return "is no whole picture";
  const std::uint64_t stamp = little_endian64(content, 0);
  const std::uint32_t frame = little_endian32(content, 8);
  if (stamp > latest_stamp_ || frame > known.frames) return "is a picture beyond the last one";
  return {};
}

}  // namespace pliant
