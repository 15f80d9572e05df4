#include "core/capture/object_cells.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/memory/row_major.hpp"

namespace pliant {

namespace {

constexpr std::int32_t kFarthest = static_cast<std::int32_t>(kFarthestView * kUnitsPerMetre) - 1;
constexpr std::uint32_t kFewestCells = 120;  // of a target
constexpr double kFarTooLarge = 2;           // times the volume: no object, but what is left of a wall

constexpr unsigned bit(Cell kind) noexcept {
  return 1U << static_cast<unsigned>(kind);
}
void widen(IntPoint& low, IntPoint& high, const IntPoint& p) noexcept {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

}  // namespace

void ObjectCells::lay_out(Workspace& workspace, const Intrinsics& camera) noexcept {
  width_ = (camera.width + 1) / 2;
  height_ = (camera.height + 1) / 2;
  const auto cells = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  kind_ = workspace.take<Cell>(cells);
  taken_ = workspace.take<std::uint8_t>(cells);
  stands_out_ = workspace.take<std::uint8_t>(cells);
  marked_ = workspace.take<std::uint8_t>(cells);
  queue_ = workspace.take<std::int32_t>(cells);
}

bool ObjectCells::reading(const Surface& surface, const BackgroundPlanes& background, int cell,
                          IntPoint& p) const noexcept {
  const int u = cell % width_ * 2, v = cell / width_ * 2;
  const std::uint16_t z8 = surface.depth_at(u, v);
  if (z8 == 0 || 2 * z8 > kFarthest) return false;
  p = surface.vertex(u, v, z8);
  if (std::abs(p.x) > kFarthest || std::abs(p.y) > kFarthest) return false;
  // 2.5 σ and 2 mm: of the table's own readings fewer than one in a hundred stand out farther.
  const std::int32_t margin = std::max(surface.sigma(p.z) * 5 / 2, 2 * kUnitsPerMillimetre) + clearance_;
  return background.stands_out(p, margin);
}

void ObjectCells::look(const Surface& surface, const BackgroundPlanes& background) noexcept {
  IntPoint p;
  for (int cell = 0; cell < width_ * height_; ++cell)
    stands_out_[static_cast<std::size_t>(cell)] = reading(surface, background, cell, p) ? 1 : 0;
}

std::size_t ObjectCells::flood(const Surface& surface, int seed, unsigned kinds, std::uint8_t mark) noexcept {
  std::size_t end = 0;
  queue_[end++] = seed;
  marked_[static_cast<std::size_t>(seed)] = mark;
  for (std::size_t at = 0; at < end; ++at) {
    const int cell = queue_[at], u = cell % width_, v = cell / width_;
    const std::uint16_t z8 = surface.depth_at(2 * u, 2 * v);
    const std::int32_t limit = 2 * surface.discontinuity(z8);
    const auto look = [&](int du, int dv) {
      const int nu = u + du, nv = v + dv;
      if (nu < 0 || nv < 0 || nu >= width_ || nv >= height_) return;
      const std::size_t next = row_major(nv, width_, nu);
      if (marked_[next] == mark || (kinds & bit(kind_[next])) == 0) return;
      if (std::abs(surface.depth_at(2 * nu, 2 * nv) - z8) > limit) return;
      marked_[next] = mark;
      queue_[end++] = static_cast<std::int32_t>(next);
    };
    look(-1, 0);
    look(1, 0);
    look(0, -1);
    look(0, 1);
  }
  return end;
}

Target ObjectCells::find_target(const Surface& surface, const BackgroundPlanes& background, int u, int v,
                                bool chosen, double size) noexcept {
  const int cells = width_ * height_;
  for (std::size_t i = 0; i < kind_.size(); ++i) kind_[i] = stands_out_[i] != 0 ? Cell::fresh : Cell::nothing;
  std::fill(marked_.begin(), marked_.end(), std::uint8_t{0});
  const auto most = static_cast<std::int32_t>(kFarTooLarge * size * kUnitsPerMetre);
  const std::int64_t reach = static_cast<std::int64_t>(width_) * width_ / 8;
  Target best;
  std::int64_t best_score = 0;
  int best_seed = -1;
  for (int seed = 0; seed < cells; ++seed) {
    if (kind_[static_cast<std::size_t>(seed)] != Cell::fresh || marked_[static_cast<std::size_t>(seed)] != 0)
      continue;
    const std::size_t count = flood(surface, seed, bit(Cell::fresh), 1);
    if (count < kFewestCells) continue;
    Target target;
    target.cells = static_cast<std::uint32_t>(count);
    target.lowest = {kFarthest, kFarthest, kFarthest};
    target.highest = {-kFarthest, -kFarthest, -kFarthest};
    std::int64_t su = 0, sv = 0, sx = 0, sy = 0, sz = 0, nearest = reach * 16;
    for (std::size_t i = 0; i < count; ++i) {
      const int cu = queue_[i] % width_, cv = queue_[i] / width_;
      const IntPoint p = surface.vertex(2 * cu, 2 * cv, surface.depth_at(2 * cu, 2 * cv));
      widen(target.lowest, target.highest, p);
      su += cu;
      sv += cv;
      sx += p.x;
      sy += p.y;
      sz += p.z;
      const std::int64_t du = 2 * cu - u, dv = 2 * cv - v;
      nearest = std::min(nearest, (du * du + dv * dv) / 4);
    }
    const auto n = static_cast<std::int64_t>(count);
    target.middle = {static_cast<std::int32_t>(sx / n), static_cast<std::int32_t>(sy / n),
                     static_cast<std::int32_t>(sz / n)};
    target.u = static_cast<int>(2 * su / n);
    target.v = static_cast<int>(2 * sv / n);
    const std::int32_t extent =
        std::max(target.highest.x - target.lowest.x, target.highest.y - target.lowest.y);
    if (!chosen && extent > most) continue;
    // How near it comes to the pixel that was asked for; without one, how near its middle is to the
    // picture's.
    const std::int64_t du = su / n - u / 2, dv = sv / n - v / 2;
    const std::int64_t off = chosen ? 64 * nearest : du * du + dv * dv;
    const std::int64_t score = (n << 16) / (reach + 8 * off);
    if (score <= best_score) continue;
    best_score = score;
    best = target;
    best_seed = seed;
  }
  std::fill(taken_.begin(), taken_.end(), std::uint8_t{0});
  if (best_seed < 0) return best;
  const std::size_t count = flood(surface, best_seed, bit(Cell::fresh), 2);
  for (std::size_t i = 0; i < count; ++i) taken_[static_cast<std::size_t>(queue_[i])] = 1;
  take_hovering(surface, background, best);
  return best;
}

void ObjectCells::take_hovering(const Surface& surface, const BackgroundPlanes& background,
                                Target& target) noexcept {
  constexpr std::int32_t kGap = 30 * kUnitsPerMillimetre, kHovers = 20 * kUnitsPerMillimetre;
  if (background.planes().empty()) return;
  const auto apart = [](std::int32_t low_a, std::int32_t high_a, std::int32_t low_b, std::int32_t high_b) {
    return std::max(low_a, low_b) - std::min(high_a, high_b) > kGap;
  };
  for (int seed = 0; seed < width_ * height_; ++seed) {
    const auto at = static_cast<std::size_t>(seed);
    if (kind_[at] != Cell::fresh || marked_[at] >= 2) continue;
    const std::size_t count = flood(surface, seed, bit(Cell::fresh), 3);
    if (count < kFewestCells / 8) continue;
    const IntPoint first = surface.vertex(seed % width_ * 2, seed / width_ * 2,
                                          surface.depth_at(seed % width_ * 2, seed / width_ * 2));
    IntPoint low = first, high = first;
    std::int32_t lowest = kFarthest;
    for (std::size_t i = 0; i < count; ++i) {
      const int u = queue_[i] % width_ * 2, v = queue_[i] / width_ * 2;
      const IntPoint p = surface.vertex(u, v, surface.depth_at(u, v));
      widen(low, high, p);
      for (const BackgroundPlane& plane : background.planes()) lowest = std::min(lowest, plane.height(p));
    }
    if (lowest < kHovers || apart(low.x, high.x, target.lowest.x, target.highest.x) ||
        apart(low.y, high.y, target.lowest.y, target.highest.y) ||
        apart(low.z, high.z, target.lowest.z, target.highest.z))
      continue;
    for (std::size_t i = 0; i < count; ++i) taken_[static_cast<std::size_t>(queue_[i])] = 1;
    target.cells += static_cast<std::uint32_t>(count);
    widen(target.lowest, target.highest, low);
    widen(target.lowest, target.highest, high);
  }
}

void ObjectCells::take_near(const Surface& surface, const DistanceVolume& volume,
                            const FixedPose& model_from_camera) noexcept {
  for (int cell = 0; cell < width_ * height_; ++cell) {
    taken_[static_cast<std::size_t>(cell)] = 0;
    if (stands_out_[static_cast<std::size_t>(cell)] == 0) continue;
    const IntPoint p = vertex(surface, cell);
    const IntPoint m = model_from_camera.point(p.x, p.y, p.z);
    taken_[static_cast<std::size_t>(cell)] = volume.holds(m) && volume.near_surface(m) ? 1 : 0;
  }
}

void ObjectCells::forbid_with(const Surface& surface, unsigned kinds, std::uint8_t mark,
                              bool (*forbidden)(const std::uint32_t (&)[5])) noexcept {
  for (int seed = 0; seed < width_ * height_; ++seed) {
    const auto at = static_cast<std::size_t>(seed);
    if (kind_[at] != Cell::fresh || marked_[at] == mark) continue;
    const std::size_t count = flood(surface, seed, kinds, mark);
    std::uint32_t of[5] = {0, 0, 0, 0, 0};
    for (std::size_t i = 0; i < count; ++i)
      ++of[static_cast<std::size_t>(kind_[static_cast<std::size_t>(queue_[i])])];
    if (!forbidden(of)) continue;
    for (std::size_t i = 0; i < count; ++i)
      if (Cell& kind = kind_[static_cast<std::size_t>(queue_[i])]; kind == Cell::fresh) kind = Cell::against;
  }
}

void ObjectCells::judge(const Surface& surface, const DistanceVolume& volume,
                        const FixedPose& model_from_camera, std::int32_t gate) noexcept {
  for (int cell = 0; cell < width_ * height_; ++cell) {
    Cell& kind = kind_[static_cast<std::size_t>(cell)];
    kind = Cell::nothing;
    if (stands_out_[static_cast<std::size_t>(cell)] == 0) continue;
    const IntPoint p = vertex(surface, cell);
    const IntPoint m = model_from_camera.point(p.x, p.y, p.z);
    if (!volume.holds(m)) {
      kind = Cell::outside;
      continue;
    }
    std::int32_t distance = 0;
    if (volume.place(m, distance) == Place::surface && std::abs(distance) <= gate * kDistanceUnits)
      kind = Cell::known;
    else
      kind = volume.stands_in_free_space(p, model_from_camera) ? Cell::against : Cell::fresh;
  }
  std::fill(marked_.begin(), marked_.end(), std::uint8_t{0});
  forbid_with(surface, bit(Cell::fresh) | bit(Cell::against), 1, [](const std::uint32_t(&of)[5]) {
    return of[static_cast<std::size_t>(Cell::against)] * 3 > of[static_cast<std::size_t>(Cell::fresh)];
  });
  // What hangs together with the known surface counts as the object; what does not, or hardly, does not.
  forbid_with(surface, bit(Cell::fresh) | bit(Cell::known), 2, [](const std::uint32_t(&of)[5]) {
    return of[static_cast<std::size_t>(Cell::known)] * 8 < of[static_cast<std::size_t>(Cell::fresh)];
  });
  for (std::uint32_t& count : counts_) count = 0;
  for (std::size_t i = 0; i < kind_.size(); ++i) {
    ++counts_[static_cast<std::size_t>(kind_[i])];
    taken_[i] = kind_[i] == Cell::known || kind_[i] == Cell::fresh ? 1 : 0;
  }
}

Window ObjectCells::window() const noexcept {
  Window w{2 * width_, 2 * height_, 0, 0};
  for (int cell = 0; cell < width_ * height_; ++cell) {
    if (taken_[static_cast<std::size_t>(cell)] == 0) continue;
    const int u = cell % width_ * 2, v = cell / width_ * 2;
    w = {std::min(w.u0, u), std::min(w.v0, v), std::max(w.u1, u + 2), std::max(w.v1, v + 2)};
  }
  return w;
}

std::size_t ObjectCells::taken() const noexcept {
  std::size_t all = 0;
  for (const std::uint8_t taken : taken_) all += taken;
  return all;
}

std::size_t ObjectCells::sample(const Surface& surface, std::int32_t normal_span,
                                std::span<ViewPoint> out) const noexcept {
  const std::size_t all = taken();
  if (all == 0) return 0;
  // As many as there is room for, spread evenly in the order of rows.
  std::size_t count = 0, seen = 0;
  for (int cv = 0; cv < height_; ++cv)
    for (int cu = 0; cu < width_; ++cu) {
      if (taken_[row_major(cv, width_, cu)] == 0) continue;
      const std::size_t before = seen * out.size() / all;
      ++seen;
      if (all > out.size() && before == seen * out.size() / all) continue;
      const std::uint16_t z8 = surface.depth_at(2 * cu, 2 * cv);
      Normal16 n;
      if (z8 == 0 || !surface.normal(2 * cu, 2 * cv, Surface::normal_step(z8, PixelSpan{normal_span}), n))
        continue;
      const IntPoint p = surface.vertex(2 * cu, 2 * cv, z8);
      out[count++] = {static_cast<std::int16_t>(p.x),
                      static_cast<std::int16_t>(p.y),
                      static_cast<std::int16_t>(p.z),
                      n.x,
                      n.y,
                      n.z};
    }
  return count;
}

}  // namespace pliant
