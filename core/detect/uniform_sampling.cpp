#include "core/detect/uniform_sampling.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

std::size_t slots_for(std::size_t capacity) noexcept {
  std::size_t slots = 64;
  while (slots < 2 * capacity) slots *= 2;
  return slots;
}

}  // namespace

void UniformSampling::lay_out(Workspace& workspace, std::size_t capacity) noexcept {
  cells_ = workspace.take<Cell>(slots_for(capacity));
  used_ = workspace.take<std::uint32_t>(capacity);
}

std::size_t UniformSampling::sample(std::span<const Point3f> points, double leaf,
                                    std::span<std::uint32_t> kept) noexcept {
  const std::size_t count = std::min(points.size(), used_.size());
  if (count == 0 || !(leaf > 0)) return 0;
  const std::size_t slots = std::min(cells_.size(), slots_for(count));
  const std::uint32_t mask = static_cast<std::uint32_t>(slots - 1);
  for (std::size_t s = 0; s < slots; ++s) cells_[s].best = 0;
  const double inverse = 1.0 / leaf;
  std::size_t used = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(points[i].x) * inverse;
    const double y = static_cast<double>(points[i].y) * inverse;
    const double z = static_cast<double>(points[i].z) * inverse;
    // False for NaN and for what does not fit a cell number.
    if (!(std::fabs(x) < 1e9 && std::fabs(y) < 1e9 && std::fabs(z) < 1e9)) continue;
    const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
    const auto cx = static_cast<std::int32_t>(fx), cy = static_cast<std::int32_t>(fy),
               cz = static_cast<std::int32_t>(fz);
    const double ox = x - fx - 0.5, oy = y - fy - 0.5, oz = z - fz - 0.5;
    const float offset = static_cast<float>(ox * ox + oy * oy + oz * oz);
    std::uint32_t hash = static_cast<std::uint32_t>(cx) * 73856093U ^
                         static_cast<std::uint32_t>(cy) * 19349663U ^
                         static_cast<std::uint32_t>(cz) * 83492791U;
    hash ^= hash >> 15;
    for (std::uint32_t slot = hash & mask;; slot = (slot + 1) & mask) {  // ends: half of the slots stay free
      Cell& cell = cells_[slot];
      if (cell.best == 0) {
        cell = {cx, cy, cz, static_cast<std::uint32_t>(i + 1), offset};
        used_[used++] = slot;
        break;
      }
      if (cell.x == cx && cell.y == cy && cell.z == cz) {
        if (offset < cell.squared_offset) {
          cell.best = static_cast<std::uint32_t>(i + 1);
          cell.squared_offset = offset;
        }
        break;
      }
    }
  }
  for (std::size_t k = 0; k < used; ++k) used_[k] = cells_[used_[k]].best - 1;
  std::sort(used_.begin(), used_.begin() + static_cast<std::ptrdiff_t>(used));
  for (std::size_t k = 0; k < std::min(used, kept.size()); ++k) kept[k] = used_[k];
  return used;
}

}  // namespace pliant
