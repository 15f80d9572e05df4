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

std::size_t PointGrid::gather_within(const Point3f& p, float radius, std::size_t most,
                                     const Gathered& out) const noexcept {
  if (most == 0 || count_ == 0) return 0;
  const float limit = radius * radius;
  const std::int32_t x0 = cell_of(p.x - radius), x1 = cell_of(p.x + radius);
  const std::int32_t y0 = cell_of(p.y - radius), y1 = cell_of(p.y + radius);
  const std::int32_t z0 = cell_of(p.z - radius), z1 = cell_of(p.z + radius);
  std::size_t held = 0, candidates = 16 * most;
  for (std::int32_t z = z0; z <= z1; ++z)
    for (std::int32_t y = y0; y <= y1; ++y) {
      const std::uint32_t row = row_of(y, z);
      std::uint32_t bucket = (row + static_cast<std::uint32_t>(x0)) & mask_;
      std::uint32_t left = static_cast<std::uint32_t>(x1 - x0) + 1;
      if (left > mask_ + 1) left = mask_ + 1;
      while (left > 0) {
        const std::uint32_t run = left < mask_ + 1 - bucket ? left : mask_ + 1 - bucket;
        std::uint32_t e = starts_[bucket];
        const std::uint32_t end = starts_[bucket + run];
        while (e < end) {
          // So many surely fit; each entry is written, and kept when it counts.
          std::size_t batch = end - e;
          if (batch > most - held) batch = most - held;
          if (batch > candidates) batch = candidates;
          candidates -= batch;
          for (const std::uint32_t last = e + static_cast<std::uint32_t>(batch); e < last; ++e) {
            const Entry& entry = entries_[e];
            const float dx = entry.position.x - p.x, dy = entry.position.y - p.y, dz = entry.position.z - p.z;
            const float square = dx * dx + dy * dy + dz * dz;
            out.x[held] = dx;
            out.y[held] = dy;
            out.z[held] = dz;
            out.square[held] = square;
            out.index[held] = entry.index;
            held += static_cast<std::size_t>(square <= limit) & static_cast<std::size_t>(rows_[e] == row);
          }
          if (held == most || candidates == 0) return held;
        }
        left -= run;
        bucket = 0;
      }
    }
  return held;
}

}  // namespace pliant
