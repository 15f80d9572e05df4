#include "core/detect/point_grid.hpp"

namespace pliant {

namespace {

/// Buckets for n points: a power of two, about two a point.
std::size_t buckets_for(std::size_t n) noexcept {
  std::size_t buckets = 64;
  while (buckets < 2 * n) buckets *= 2;
  return buckets;
}

bool finite(const Point3f& p) noexcept {
  const float sum = p.x - p.x + (p.y - p.y) + (p.z - p.z);
  return sum == 0;
}

}  // namespace

void PointGrid::lay_out(Workspace& workspace, std::size_t capacity) noexcept {
  entries_ = workspace.take<Entry>(capacity);
  rows_ = workspace.take<std::uint32_t>(capacity);
  bucket_of_ = workspace.take<std::uint32_t>(capacity);
  starts_ = workspace.take<std::uint32_t>(buckets_for(capacity) + 1);
  count_ = 0;
}

bool PointGrid::build(std::span<const Point3f> points, double cell) noexcept {
  count_ = 0;
  if (points.size() > entries_.size() || !(cell > 0)) return false;
  cell_ = cell;
  inverse_cell_ = 1.0 / cell;
  const std::size_t buckets = buckets_for(points.size());
  mask_ = static_cast<std::uint32_t>(buckets - 1);
  for (std::size_t b = 0; b <= buckets; ++b) starts_[b] = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f& p = points[i];
    if (!finite(p)) continue;
    const std::uint32_t row = row_of(cell_of(p.y), cell_of(p.z));
    bucket_of_[i] = (row + static_cast<std::uint32_t>(cell_of(p.x))) & mask_;
    ++starts_[bucket_of_[i] + 1];
    ++count_;
  }
  for (std::size_t b = 0; b < buckets; ++b) starts_[b + 1] += starts_[b];
  // Backwards, so that a bucket's start ends up where it belongs and its points stand in ascending order.
  for (std::size_t b = buckets; b > 0; --b) starts_[b] = starts_[b - 1];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f& p = points[i];
    if (!finite(p)) continue;
    const std::uint32_t at = starts_[bucket_of_[i] + 1]++;
    entries_[at] = {p, static_cast<std::uint32_t>(i)};
    rows_[at] = row_of(cell_of(p.y), cell_of(p.z));
  }
  return true;
}

}  // namespace pliant
