#include "core/track/placed_points.hpp"

#include "core/track/associate.hpp"
#include "core/track/contour.hpp"

namespace pliant {

void PlacedPoints::place(const PointColumns& from, std::size_t count, const FixedPose& pose) noexcept {
  // 16 bits each, as Q14 of a rotation fits: products of 16 bits are what vectors multiply best.
  std::array<std::int16_t, 9> r{};
  for (std::size_t k = 0; k < r.size(); ++k) r[k] = static_cast<std::int16_t>(pose.r[k]);
  const auto turn = [&](const std::int16_t* from_x, const std::int16_t* from_y, const std::int16_t* from_z,
                        std::size_t row, std::int32_t shift, std::int32_t* out) {
    const std::int16_t a = r[row], b = r[row + 1], c = r[row + 2];
    for (std::size_t k = 0; k < count; ++k)
      out[k] = ((a * from_x[k] + b * from_y[k] + c * from_z[k] + 8192) >> 14) + shift;
  };
  turn(from.x, from.y, from.z, 0, pose.t[0], x.data());
  turn(from.x, from.y, from.z, 3, pose.t[1], y.data());
  turn(from.x, from.y, from.z, 6, pose.t[2], z.data());
  turn(from.nx, from.ny, from.nz, 0, 0, nx.data());
  turn(from.nx, from.ny, from.nz, 3, 0, ny.data());
  turn(from.nx, from.ny, from.nz, 6, 0, nz.data());
  for (std::size_t k = 0; k < count; ++k) {
    const bool facing = faces_camera(point(k), normal(k), kCos75), rim = on_rim(point(k), normal(k));
    side[k] = facing ? Side::facing : rim ? Side::rim : Side::away;
  }
}

}  // namespace pliant
