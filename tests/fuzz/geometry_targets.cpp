#include <cmath>

#include "drivers/geometry_files/parsers.hpp"
#include "drivers/images/png.hpp"
#include "tests/fuzz/promises.hpp"
#include "tests/fuzz/targets.hpp"

namespace pliant {

namespace {

void check(const Result<Geometry>& result, Bytes data) {
  if (!result) {
    check_error(result.error());
    return;
  }
  const Geometry& g = *result;
  promise(!g.vertices.empty(), "a geometry has vertices");
  promise(g.normals.empty() || g.normals.size() == g.vertices.size(), "no normal or one a vertex");
  promise(g.original_index.empty() == (g.dropped == 0),
          "dropped vertices and numbers of the rest go together");
  promise(g.original_index.empty() || g.original_index.size() == g.vertices.size(), "one number a vertex");
  for (const Point3f& p : g.vertices)
    promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "vertices are finite");
  for (const auto& t : g.triangles)
    for (const std::uint32_t corner : t) promise(corner < g.vertices.size(), "corners are vertices");
  // LZF unpacks up to 88 bytes from one; a vertex takes 12 bytes or more unpacked.
  promise(g.vertices.size() <= 90 * data.size() && g.triangles.size() <= data.size(),
          "no more than the bytes hold");
}

}  // namespace

void fuzz_ply(Bytes data) {
  check(parse_ply(data, "file"), data);
}
void fuzz_obj(Bytes data) {
  check(parse_obj(data, "file"), data);
}
void fuzz_stl(Bytes data) {
  check(parse_stl(data, "file"), data);
}
void fuzz_off(Bytes data) {
  check(parse_off(data, "file"), data);
}
void fuzz_pcd(Bytes data) {
  check(parse_pcd(data, "file"), data);
}

void fuzz_png(Bytes data) {
  GreyImage16 image;
  const Outcome decoded = PngReader::decode(data, "file", image);
  if (!decoded) {
    check_error(decoded.error());
    return;
  }
  promise(image.width > 0 && image.height > 0, "a picture has a size");
  promise(
      image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
      "a pixel for each place");
}

}  // namespace pliant
