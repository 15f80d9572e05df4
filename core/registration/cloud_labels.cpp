#include "core/registration/cloud_labels.hpp"

#include <cmath>

#include "core/detect/fast_transform.hpp"

namespace pliant {

void SurfaceReadings::lay_out(Workspace& workspace, std::size_t model_points) noexcept {
  sum_ = workspace.take<float>(model_points);
  squares_ = workspace.take<float>(model_points);
  distance_ = workspace.take<float>(model_points);
  count_ = workspace.take<std::uint32_t>(model_points);
  nearest_ = workspace.take<std::uint32_t>(model_points);
}

void SurfaceReadings::measure(const ModelView& model, const PointGrid& index, std::span<const Point3f> scene,
                              std::span<const std::uint8_t> taken, const RigidTransform& pose, double across,
                              double depth) noexcept {
  for (std::size_t i = 0; i < model.size(); ++i) {
    sum_[i] = squares_[i] = distance_[i] = 0;
    count_[i] = 0;
    nearest_[i] = PointGrid::kNone;
  }
  const FastTransform back(pose.inverse());
  const auto wide = static_cast<float>(across * across), deep = static_cast<float>(depth);
  const auto reach = static_cast<float>(std::sqrt(across * across + depth * depth));
  const ModelHeader& h = model.header();
  float low[3], high[3];
  for (int k = 0; k < 3; ++k) {
    low[k] = static_cast<float>(h.lowest[k]) - reach;
    high[k] = static_cast<float>(h.highest[k]) + reach;
  }
  for (std::size_t j = 0; j < scene.size(); ++j) {
    if (!taken.empty() && taken[j] != 0) continue;
    const Point3f p = back.point(scene[j]);
    if (p.x < low[0] || p.y < low[1] || p.z < low[2] || p.x > high[0] || p.y > high[1] || p.z > high[2])
      continue;
    float square = 0;
    const std::uint32_t i = index.nearest(p, reach, square);
    if (i == PointGrid::kNone) continue;
    const Point3f& m = model.positions()[i];
    const Normal16& n = model.normals()[i];
    const float along = (static_cast<float>(n.x) * (p.x - m.x) + static_cast<float>(n.y) * (p.y - m.y) +
                         static_cast<float>(n.z) * (p.z - m.z)) *
                        (1.0F / 16384);
    if (std::fabs(along) > deep || square - along * along > wide) continue;
    sum_[i] += along;
    squares_[i] += along * along;
    if (count_[i]++ == 0 || square < distance_[i]) {
      distance_[i] = square;
      nearest_[i] = static_cast<std::uint32_t>(j);
    }
  }
  for (std::size_t i = 0; i < model.size(); ++i) distance_[i] = std::sqrt(distance_[i]);
}

SurfaceGap SurfaceReadings::gap(const ModelView& model, std::size_t i) const noexcept {
  float sum = sum_[i], squares = squares_[i];
  std::uint32_t count = count_[i];
  const Normal16& n = model.normals()[i];
  for (const std::uint16_t j : model.neighbours(i)) {
    if (j == kNoNeighbour) continue;
    const Normal16& m = model.normals()[j];
    if (std::int32_t{n.x} * m.x + std::int32_t{n.y} * m.y + std::int32_t{n.z} * m.z < (1 << 27))
      continue;  // 60°
    sum += sum_[j];
    squares += squares_[j];
    count += count_[j];
  }
  SurfaceGap gap;
  gap.count = count;
  if (count == 0) return gap;
  const float k = 1.0F / static_cast<float>(count);
  gap.along = sum * k;
  const float variance = squares * k - gap.along * gap.along;
  gap.spread = variance > 0 ? std::sqrt(variance) : 0;
  return gap;
}

void IslandFilter::lay_out(Workspace& workspace, std::size_t points) noexcept {
  piece_ = workspace.take<std::uint32_t>(points);
  queue_ = workspace.take<std::uint16_t>(points);
}

}  // namespace pliant
