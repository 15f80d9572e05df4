// What is refused of an .oni file before the library sees it, record by record.
#include "drivers/openni2/oni_layout.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "drivers/openni2/oni_records.hpp"

namespace pliant {
namespace {

using Type = OniRecordType;

template <typename Number>
std::string little(Number value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof value; ++i)
    bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 255U);
  return bytes;
}
std::string text(const std::string& letters) {
  return little(static_cast<std::uint32_t>(letters.size() + 1)) + letters + '\0';
}
std::string property(const std::string& name, const std::string& value) {
  return text(name) + little(static_cast<std::uint32_t>(value.size())) + value;
}

/// A recording of two pictures, whose parts a test may spoil before bytes() puts them together.
struct Recording {
  bool old = false;  // the headers of files before 1.0.1.0
  std::uint32_t maintenance = 1, build = 0, highest = 1, frames = 2, kind = 2, depth = 1;
  std::uint64_t latest = 2000;
  std::string codec = "NONE", mode = little(320U) + little(240U) + little(30U),
              size = little(std::uint64_t{153600});
  std::string mode_name = "xnMapOutputMode", more, payload_of_property, picture = std::string(100, 'x');
  std::uint32_t table_stream = 1, table_frames = 2, second_frame = 2;
  std::uint64_t second_stamp = 2000;
  bool ready = true, begins = true, table = true;
  std::int64_t table_moved = 0;

  [[nodiscard]] std::string record(std::uint32_t type, std::uint32_t stream, const std::string& fields = {},
                                   const std::string& payload = {}) const {
    const std::uint32_t head = old ? 24 : 28;
    return "NIR" + std::string(1, '\0') + little(type) + little(stream) +
           little(static_cast<std::uint32_t>(head + fields.size())) +
           little(static_cast<std::uint32_t>(payload.size())) +
           (old ? little(0U) : little(std::uint64_t{0})) + fields + payload;
  }
  [[nodiscard]] std::string added(std::uint32_t stream, std::uint32_t what, const std::string& with_codec,
                                  std::uint32_t pictures, std::uint64_t place) const {
    return record(Type::kStreamAdded, stream,
                  text("Node" + std::to_string(stream)) + little(what) + with_codec + little(pictures) +
                      little(std::uint64_t{1000}) + little(std::uint64_t{2000}) +
                      (old ? little(static_cast<std::uint32_t>(place)) : little(place)));
  }
  [[nodiscard]] std::string bytes() const {
    const std::string header = "NI10" + std::string("\1\0", 2) +
                               little(static_cast<std::uint16_t>(maintenance)) + little(build) +
                               little(latest) + little(highest);
    const auto all = [&](std::uint64_t place) {
      std::string b = header;
      b += added(0, 1, little(0U), 0, 0) + record(Type::kStreamReady, 0);
      b += added(depth, kind, codec, frames, place);
      b += record(Type::kBytes, depth, property(mode_name, mode), payload_of_property);
      b += record(Type::kInt, depth, property("oniRequiredFrameSize", size)) + more;
      if (ready) b += record(Type::kStreamReady, depth);
      if (begins) b += record(Type::kDataBegins, depth, little(2U) + little(std::uint64_t{2000}));
      b += record(Type::kPicture, depth, little(std::uint64_t{1000}) + little(1U), picture);
      b += record(Type::kPicture, depth, little(second_stamp) + little(second_frame), picture);
      return b;
    };
    const std::size_t before = all(1).size();
    std::string b = all(table ? before + static_cast<std::uint64_t>(table_moved) : 0);
    if (table)
      b += record(Type::kSeekTable, table_stream, {}, std::string((table_frames + 1) * (old ? 16 : 20), 'i'));
    return b + record(Type::kEnd, 0);
  }
};

std::string refusal(const std::string& bytes) {
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string copy = bytes;
  const std::unique_ptr<std::FILE, Close> file(fmemopen(copy.data(), copy.size(), "rb"));
  const Outcome outcome = check_oni_layout(file.get(), copy.size(), "f.oni");
  return outcome ? "" : outcome.error().message;
}

TEST(OniLayout, ASoundRecordingPasses) {
  EXPECT_EQ(refusal(Recording{}.bytes()), "");
  Recording other;
  other.table = false;
  other.more = other.record(Type::kText, 1, property("xnNote", std::string("any text\0", 9))) +
               other.record(Type::kReal, 1, property("ZPPS", little(std::uint64_t{0}))) +
               other.record(Type::kBytes, 1, property("S2D", std::string(20'000, 't')));
  EXPECT_EQ(refusal(other.bytes()), "");
}

TEST(OniLayout, SoDoesOneOfTheOldKindWithItsShorterHeaders) {
  Recording old;
  old.old = true;
  old.maintenance = 0;
  old.build = 5;
  EXPECT_EQ(refusal(old.bytes()), "");
  old.old = false;
  EXPECT_NE(refusal(old.bytes()), "");
}

struct Spoiled {
  const char* name;
  std::function<void(Recording&)> how;
  const char* told;
};
void PrintTo(const Spoiled& spoiled, std::ostream* out) {
  *out << spoiled.told;
}
class Spoiling : public testing::TestWithParam<Spoiled> {};

TEST_P(Spoiling, IsRefusedWithTheReason) {
  Recording recording;
  GetParam().how(recording);
  const std::string told = refusal(recording.bytes());
  EXPECT_NE(told.find("f.oni: "), std::string::npos);
  EXPECT_NE(told.find(GetParam().told), std::string::npos) << told;
}

constexpr const char* kNoStream = "is of a stream that is not there";
constexpr const char* kNoSize = "wants pictures of a size that cannot be";
constexpr const char* kNoName = "holds no sound name and value";
constexpr const char* kBeyond = "is a picture beyond the last one";

INSTANTIATE_TEST_SUITE_P(
    All, Spoiling,
    testing::Values(
        Spoiled{"VersionTooNew", [](Recording& r) { r.build = 1; }, "version 1.0.1.1"},
        Spoiled{"VersionTooOld", [](Recording& r) { r.maintenance = 0; }, "version 1.0.0.0"},
        Spoiled{"PayloadOfAProperty", [](Recording& r) { r.payload_of_property = "behind"; },
                "has a payload where there is none"},
        Spoiled{"UnknownKindOfRecord", [](Recording& r) { r.more = r.record(15, 1); }, "is of no known kind"},
        Spoiled{"StreamAboveTheHighest", [](Recording& r) { r.highest = 0; }, "adds a stream that cannot be"},
        Spoiled{"StreamTwice", [](Recording& r) { r.depth = 0; }, "adds a stream that cannot be"},
        Spoiled{"UnknownCodec", [](Recording& r) { r.codec = "16zX"; }, "adds a stream that cannot be"},
        Spoiled{"NoCodec", [](Recording& r) { r.codec = std::string(4, '\0'); },
                "adds a stream that cannot be"},
        Spoiled{"PicturesOfAStreamWithoutAny", [](Recording& r) { r.kind = 1; }, kNoStream},
        Spoiled{"NoSize", [](Recording& r) { r.mode_name = "xnMapOutputMods"; },
                "is of a stream without a size"},
        Spoiled{"WidthOfZero", [](Recording& r) { r.mode = little(0U) + little(240U) + little(30U); },
                kNoSize},
        Spoiled{"HeightOfBillions",
                [](Recording& r) { r.mode = little(320U) + little(0x80000000U) + little(30U); }, kNoSize},
        Spoiled{"ModeCutShort", [](Recording& r) { r.mode = little(320U); }, kNoName},
        Spoiled{"FrameSizeOfZero", [](Recording& r) { r.size = little(std::uint64_t{0}); }, kNoSize},
        Spoiled{"FrameSizeNegative", [](Recording& r) { r.size = little(std::uint64_t{0xFFFFFFFFU}); },
                kNoSize},
        Spoiled{"NumberCutShort", [](Recording& r) { r.size = little(153600U); }, kNoName},
        Spoiled{"TextWithoutEnd",
                [](Recording& r) { r.more = r.record(Type::kText, 1, property("xnNote", "endless")); },
                kNoName},
        Spoiled{
            "PropertyOfNoStream",
            [](Recording& r) { r.more = r.record(Type::kInt, 7, property("a", little(std::uint64_t{1}))); },
            kNoStream},
        Spoiled{"StreamNeverReady", [](Recording& r) { r.ready = false; }, kNoStream},
        Spoiled{"StreamRemovedBeforeItsPictures",
                [](Recording& r) { r.more = r.record(Type::kStreamRemoved, 1); }, kNoStream},
        Spoiled{"DataNeverBegin", [](Recording& r) { r.begins = false; }, "holds no picture"},
        Spoiled{"PictureNumberTooHigh", [](Recording& r) { r.second_frame = 3; }, kBeyond},
        Spoiled{"PictureLaterThanTheLatest", [](Recording& r) { r.second_stamp = 2001; }, kBeyond},
        Spoiled{"PictureWithoutContent", [](Recording& r) { r.picture = ""; }, "is no whole picture"},
        Spoiled{"PictureTooLarge", [](Recording& r) { r.picture = std::string(6'000'000, 'x'); },
                "is larger than a record can be"},
        Spoiled{"SeekTableElsewhere", [](Recording& r) { r.table_moved = -4; },
                "whose seek table is not there"},
        Spoiled{"SeekTableBeyondTheEnd", [](Recording& r) { r.table_moved = 1 << 20; },
                "is cut short: the record at byte"},
        Spoiled{"SeekTableOfAnother", [](Recording& r) { r.table_stream = 0; },
                "whose seek table is not there"},
        Spoiled{"SeekTableTooShort", [](Recording& r) { r.table_frames = 1; },
                "whose seek table is not there"},
        Spoiled{"TooManyFrames", [](Recording& r) { r.frames = 0xFFFFFFFFU; },
                "adds a stream of too many frames"}),
    [](const auto& about) { return about.param.name; });

}  // namespace
}  // namespace pliant
