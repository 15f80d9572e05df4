// Wavefront OBJ.
#include <array>

#include "drivers/geometry_files/finish.hpp"
#include "drivers/geometry_files/numbers.hpp"
#include "drivers/geometry_files/parsers.hpp"

namespace pliant {

namespace {

bool read_point(std::string_view line, Point3f& point) {
  std::array<double, 3> xyz{};
  std::string_view word;
  for (double& value : xyz)
    if (!take_word(line, word) || !to_number(word, value)) return false;
  point = {to_float(xyz[0]), to_float(xyz[1]), to_float(xyz[2])};
  return true;
}

/// "-1" is the last of `count`, "1" the first; false when it is none of them.
bool resolve(std::string_view word, std::size_t count, std::uint32_t& index) {
  std::int64_t number = 0;
  if (!to_integer(word, number)) return false;
  const auto size = static_cast<std::int64_t>(count);
  if (number == 0 || number < -size || number > size)
    return false;  // before any sum: it is any 64-bit number
  index = static_cast<std::uint32_t>(number < 0 ? size + number : number - 1);
  return true;
}

class ObjReader {
 public:
  explicit ObjReader(std::string_view name) : name_(name) {}

  Outcome read_line(std::string_view line, std::size_t number) {
    std::string_view key;
    if (!take_word(line, key)) return success();
    Point3f point;
    if (key == "v") {
      if (!read_point(line, point)) return line_error(name_, number, "a vertex needs three numbers");
      geometry_.vertices.push_back(point);
    } else if (key == "vn") {
      if (!read_point(line, point)) return line_error(name_, number, "a normal needs three numbers");
      file_normals_.push_back(point);
    } else if (key == "f") {
      return read_face(line, number);
    }
    return success();
  }

  Result<Geometry> finish() {
    if (geometry_.triangles.empty() && file_normals_.size() == geometry_.vertices.size())
      geometry_.normals = std::move(file_normals_);
    else if (faces_have_normals_)
      geometry_.normals.resize(geometry_.vertices.size());  // vertices of no face keep none
    return finish_geometry(std::move(geometry_), name_);
  }

 private:
  Outcome read_face(std::string_view line, std::size_t number) {
    corners_.clear();
    std::string_view word;
    while (take_word(line, word)) {
      if (word.starts_with('#')) break;
      const std::size_t slash = word.find('/');
      std::uint32_t corner = 0;
      if (!resolve(word.substr(0, slash), geometry_.vertices.size(), corner))
        return line_error(name_, number,
                          fmt::format("'{}' names none of the {} vertices above it",
                                      shown(word.substr(0, slash)), geometry_.vertices.size()));
      corners_.push_back(corner);
      const std::size_t second = slash == std::string_view::npos ? slash : word.find('/', slash + 1);
      if (second == std::string_view::npos || second + 1 == word.size()) continue;
      std::uint32_t normal = 0;
      if (!resolve(word.substr(second + 1), file_normals_.size(), normal))
        return line_error(
            name_, number,
            fmt::format("'{}' names none of the {} normals above it", shown(word), file_normals_.size()));
      add_normal(corner, file_normals_[normal]);
    }
    if (corners_.size() < 3) return line_error(name_, number, "a face needs three vertices or more");
    add_polygon(geometry_, corners_);
    return success();
  }

  void add_normal(std::uint32_t vertex, const Point3f& normal) {
    faces_have_normals_ = true;
    if (geometry_.normals.size() < geometry_.vertices.size())
      geometry_.normals.resize(geometry_.vertices.size());
    Point3f& sum = geometry_.normals[vertex];
    sum = {sum.x + normal.x, sum.y + normal.y, sum.z + normal.z};
  }

  std::string_view name_;
  Geometry geometry_;
  std::vector<Point3f> file_normals_;
  std::vector<std::uint32_t> corners_;
  bool faces_have_normals_ = false;
};

}  // namespace

Result<Geometry> parse_obj(std::span<const std::byte> data, std::string_view name) {
  ObjReader reader(name);
  TextCursor cursor(data);
  std::string_view line;
  std::string joined;
  while (cursor.next_line(line)) {
    const std::size_t number = cursor.line();
    if (line.ends_with('\\')) {  // goes on in the next line
      joined.clear();
      while (line.ends_with('\\')) {
        joined.append(line.substr(0, line.size() - 1));
        if (!cursor.next_line(line)) line = {};
      }
      joined.append(line);
      line = joined;
    }
    if (const Outcome read = reader.read_line(line, number); !read) return read.error();
  }
  return reader.finish();
}

}  // namespace pliant
