// PLY: the vertices, normals and faces of any of its three encodings.
#include <array>
#include <cmath>

#include "drivers/geometry_files/finish.hpp"
#include "drivers/geometry_files/parsers.hpp"
#include "drivers/geometry_files/ply_header.hpp"

namespace pliant {

namespace {

/// Numbers one after the other, whatever the encoding.
class NumberStream {
 public:
  NumberStream(std::span<const std::byte> data, const PlyHeader& header, std::string_view name)
      : name_(name),
        data_(data),
        position_(header.bytes),
        encoding_(header.encoding),
        words_(data.subspan(header.bytes)) {
    words_.set_first_line(header.lines);
  }

  [[nodiscard]] bool ascii() const { return encoding_ == PlyEncoding::ascii; }
  [[nodiscard]] std::uint64_t remaining() const {
    return ascii() ? words_.remaining() : data_.size() - position_;
  }
  /// False at the end of the file or, for ascii, at a word that is no number.
  bool read(NumberType type, double& value) {
    if (ascii()) {
      ended_ = !words_.next_word(word_);
      return !ended_ && to_number(word_, value);
    }
    const std::size_t size = size_of(type);
    ended_ = data_.size() - position_ < size;
    if (ended_) return false;
    value = read_number(data_.data() + position_, type, encoding_ == PlyEncoding::big_endian);
    position_ += size;
    return true;
  }
  /// The error after a failed read().
  [[nodiscard]] Error error(const PlyElement& element, std::uint64_t item) const {
    if (ended_)
      return here(fmt::format("the file ends inside {} {} of {}; is it cut short?", shown(element.name), item,
                              element.count));
    return here(fmt::format("'{}' is no number ({} {})", shown(word_), shown(element.name), item));
  }
  [[nodiscard]] Error here(std::string_view what) const {
    return ascii() ? line_error(name_, words_.line(), what) : byte_error(name_, position_, what);
  }

 private:
  std::string_view name_;
  std::span<const std::byte> data_;
  std::size_t position_;
  PlyEncoding encoding_;
  TextCursor words_;
  std::string_view word_;
  bool ended_ = false;
};

/// One item of an element: its scalars, and the one list that is wanted.
struct Item {
  std::vector<double> scalars;       // one a property, 0 for lists
  std::vector<std::int64_t> wanted;  // contents of the wanted list
};

Outcome read_item(NumberStream& stream, const PlyElement& element, std::uint64_t index, int wanted,
                  Item& item) {
  item.wanted.clear();
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    double value = 0;
    if (!stream.read(property.is_list ? property.count_type : property.type, value))
      return stream.error(element, index);
    item.scalars[p] = property.is_list ? 0 : value;
    if (!property.is_list) continue;
    if (!(value >= 0) || value != std::floor(value) || value > static_cast<double>(stream.remaining()))
      return stream.here(fmt::format("{} {} has an impossible list length", shown(element.name), index));
    const auto length = static_cast<std::uint64_t>(value);
    for (std::uint64_t i = 0; i < length; ++i) {
      if (!stream.read(property.type, value)) return stream.error(element, index);
      if (static_cast<int>(p) != wanted) continue;
      if (!(value >= -1) || value > 4294967295.0 || value != std::floor(value))
        return stream.here(
            fmt::format("{} {} holds an impossible vertex number", shown(element.name), index));
      item.wanted.push_back(static_cast<std::int64_t>(value));
    }
  }
  return success();
}

/// A strip, -1 beginning a new one; every second triangle is turned over.
void add_strip(Geometry& geometry, const std::vector<std::int64_t>& corners) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] < 0) first = i + 1;
    if (corners[i] < 0 || i < first + 2) continue;
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = static_cast<std::uint32_t>(corners[i - 2 + k]);
    if ((i - first) % 2 == 1) std::swap(triangle[0], triangle[1]);
    geometry.triangles.push_back(triangle);
  }
}

class PlyReader {
 public:
  PlyReader(NumberStream& stream, Geometry& geometry) : stream_(stream), geometry_(geometry) {}

  Outcome read(const PlyElement& element) {
    const std::uint64_t least = element.least_bytes(stream_.ascii());
    if (least == 0) return success();  // nothing is stored for it
    // The last number of an ascii file needs no blank behind it.
    const std::uint64_t room = (stream_.remaining() + (stream_.ascii() ? 1 : 0)) / least;
    if (element.count > room)
      return stream_.here(
          fmt::format("the header says {} of element '{}', but the file has room for {} at most; "
                      "is it cut short?",
                      element.count, shown(element.name), room));
    item_.scalars.assign(element.properties.size(), 0);
    if (element.name == "vertex") return read_vertices(element);
    return read_faces(element);
  }

 private:
  Outcome read_vertices(const PlyElement& element) {
    if (!geometry_.vertices.empty()) return stream_.here("a second element 'vertex'");
    std::array<int, 6> column{};
    constexpr std::array<std::string_view, 6> names = {"x", "y", "z", "nx", "ny", "nz"};
    for (std::size_t k = 0; k < 6; ++k) {
      column[k] = element.find(names[k]);
      if (column[k] >= 0 && element.properties[static_cast<std::size_t>(column[k])].is_list) column[k] = -1;
      if (k < 3 && column[k] < 0)
        return stream_.here(fmt::format("element 'vertex' has no property '{}'", names[k]));
    }
    const bool normals = column[3] >= 0 && column[4] >= 0 && column[5] >= 0;
    geometry_.vertices.reserve(static_cast<std::size_t>(element.count));
    if (normals) geometry_.normals.reserve(static_cast<std::size_t>(element.count));
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (Outcome read = read_item(stream_, element, i, -1, item_); !read) return read;
      const auto at = [&](std::size_t k) {
        return to_float(item_.scalars[static_cast<std::size_t>(column[k])]);
      };
      geometry_.vertices.push_back({at(0), at(1), at(2)});
      if (normals) geometry_.normals.push_back({at(3), at(4), at(5)});
    }
    return success();
  }

  /// Faces and strips; for every other element the numbers are only passed over.
  Outcome read_faces(const PlyElement& element) {
    int wanted = -1;
    for (const std::string_view list : {"vertex_indices", "vertex_index"})
      if (wanted < 0 && (element.name == "face" || element.name == "tristrips")) wanted = element.find(list);
    if (wanted >= 0 && !element.properties[static_cast<std::size_t>(wanted)].is_list) wanted = -1;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (Outcome read = read_item(stream_, element, i, wanted, item_); !read) return read;
      if (element.name == "tristrips") {
        add_strip(geometry_, item_.wanted);
        continue;
      }
      corners_.clear();
      for (const std::int64_t corner : item_.wanted) {
        if (corner < 0) return stream_.here(fmt::format("face {} names vertex {}", i, corner));
        corners_.push_back(static_cast<std::uint32_t>(corner));
      }
      add_polygon(geometry_, corners_);
    }
    return success();
  }

  NumberStream& stream_;
  Geometry& geometry_;
  Item item_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<Geometry> parse_ply(std::span<const std::byte> data, std::string_view name) {
  const Result<PlyHeader> header = parse_ply_header(data, name);
  if (!header) return header.error();
  NumberStream stream(data, *header, name);
  Geometry geometry;
  PlyReader reader(stream, geometry);
  for (const PlyElement& element : header->elements)
    if (const Outcome read = reader.read(element); !read) return read.error();
  return finish_geometry(std::move(geometry), name);
}

}  // namespace pliant
