#include "drivers/geometry_files/points_ply.hpp"

#include <fmt/format.h>

#include <string>

#include "drivers/geometry_files/atomic_file.hpp"
#include "drivers/geometry_files/little_endian.hpp"
#include "drivers/geometry_files/region_colours.hpp"

namespace pliant {

namespace {

constexpr std::size_t kRestOffset = 12, kRegionOffset = 24;

}  // namespace

PointsPlyWriter::PointsPlyWriter(std::span<const Point3f> rest) : points_(rest.size()) {
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float rest_x\nproperty float rest_y\nproperty float rest_z\n"
      "property int region\nproperty int match\nproperty float residual\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
      points_);
  header_bytes_ = header.size();
  bytes_.resize(header_bytes_ + points_ * kBytesPerPoint);
  std::byte* at = bytes_.data();
  for (const char c : header) at = put_u8(at, static_cast<std::uint8_t>(c));
  for (std::size_t i = 0; i < points_; ++i) {
    at = bytes_.data() + header_bytes_ + i * kBytesPerPoint + kRestOffset;
    put_float(put_float(put_float(at, rest[i].x), rest[i].y), rest[i].z);
  }
}

Outcome PointsPlyWriter::write(const char* path, std::span<const Point3f> positions,
                               std::span<const std::int8_t> labels, std::span<const std::int32_t> matches,
                               std::span<const float> residuals) {
  if (positions.size() != points_ || labels.size() != points_ || matches.size() != points_ ||
      residuals.size() != points_)
    return Error{ErrorKind::write,
                 fmt::format("{}: the result does not have the model's {} points", path, points_)};
  for (std::size_t i = 0; i < points_; ++i) {
    std::byte* at = bytes_.data() + header_bytes_ + i * kBytesPerPoint;
    put_float(put_float(put_float(at, positions[i].x), positions[i].y), positions[i].z);
    at = put_float(put_i32(put_i32(at + kRegionOffset, labels[i]), matches[i]), residuals[i]);
    const RegionColour colour = region_colour(labels[i]);
    put_u8(put_u8(put_u8(at, colour.red), colour.green), colour.blue);
  }
  return write_whole_file(path, bytes_, false);
}

}  // namespace pliant
