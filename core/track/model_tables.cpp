#include "core/track/model_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pliant {

namespace {

std::int32_t rounded(double x) {
  return static_cast<std::int32_t>(std::floor(x + 0.5));
}

}  // namespace

void ModelTables::lay_out(Workspace& workspace, std::size_t points) noexcept {
  size = points;
  for (auto* table : {&x, &y, &z, &nx, &ny, &nz}) *table = workspace.take<std::int16_t>(points);
  by_patch.lay_out(workspace, points);
}

void ModelTables::start(const ModelView& view) noexcept {
  model = &view;
  centre = view.centre();
  spacing = rounded(view.spacing() * kUnitsPerMetre);
  if (spacing < 1) spacing = 1;
  for (std::size_t i = 0; i < size; ++i) {
    const Point3f& p = view.positions()[i];
    x[i] = static_cast<std::int16_t>(rounded((static_cast<double>(p.x) - centre.x()) * kUnitsPerMetre));
    y[i] = static_cast<std::int16_t>(rounded((static_cast<double>(p.y) - centre.y()) * kUnitsPerMetre));
    z[i] = static_cast<std::int16_t>(rounded((static_cast<double>(p.z) - centre.z()) * kUnitsPerMetre));
    nx[i] = view.normals()[i].x;
    ny[i] = view.normals()[i].y;
    nz[i] = view.normals()[i].z;
  }
  by_patch.start(*this);
}

FixedPose::FixedPose(const RigidTransform& pose, const Vector3& centre) noexcept {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      r[3 * row + column] = rounded(pose.rotation(row, column) * 16384.0);
  const Vector3 where = pose * centre;
  for (int i = 0; i < 3; ++i) t[i] = rounded(where[i] * kUnitsPerMetre);
}

void Projector::start(const Intrinsics& camera) noexcept {
  fx_ = rounded(camera.fx * 8);
  fy_ = rounded(camera.fy * 8);
  cx_ = rounded(camera.cx * 8) + 4;  // half a pixel, so that the shift rounds
  cy_ = rounded(camera.cy * 8) + 4;
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  widest_x_ = kMost / fx_;
  widest_y_ = kMost / fy_;
  width_ = camera.width;
  height_ = camera.height;
}

}  // namespace pliant
