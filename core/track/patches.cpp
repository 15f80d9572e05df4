#include "core/track/patches.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

constexpr std::size_t kPointsEach = 24;  // fewer would not tell a patch's turn from noise

Vector3 rest(const ModelTables& model, std::size_t i) noexcept {
  return model.centre + Vector3(model.x[i], model.y[i], model.z[i]) / kUnitsPerMetre;
}

void spread_from_seeds(const ModelTables& model, std::span<std::uint16_t> queue, PatchTables& t) noexcept {
  constexpr std::uint8_t kNone = 0xFF;
  static_assert(kMaxPatches < kNone);
  std::fill(t.patch_of.begin(), t.patch_of.end(), kNone);
  std::size_t head = 0, tail = 0;
  for (std::size_t p = 0; p < t.count; ++p) {
    t.patch_of[p] = static_cast<std::uint8_t>(p);
    queue[tail++] = static_cast<std::uint16_t>(p);
  }
  while (head < tail) {
    const std::size_t i = queue[head++];
    for (const std::uint16_t n : model.model->neighbours(i)) {
      if (n >= model.size || t.patch_of[n] != kNone) continue;
      t.patch_of[n] = t.patch_of[i];
      queue[tail++] = n;
    }
  }
  for (std::size_t i = 0; i < model.size; ++i)
    if (t.patch_of[i] == kNone) t.patch_of[i] = 0;  // not connected to any seed
}

void find_borders(const ModelTables& model, PatchTables& t) noexcept {
  t.neighbours = {};
  for (std::size_t i = 0; i < model.size; ++i)
    for (const std::uint16_t n : model.model->neighbours(i)) {
      if (n >= model.size || t.patch_of[n] == t.patch_of[i]) continue;
      t.neighbours[t.patch_of[i]].add(t.patch_of[n]);
      t.neighbours[t.patch_of[n]].add(t.patch_of[i]);
    }
  std::array<std::uint16_t, kMaxPatches> first{};  // of each patch's borders
  t.border_count = 0;
  for (std::size_t a = 0; a < t.count; ++a) {
    first[a] = static_cast<std::uint16_t>(t.border_count);
    for (std::size_t b = a + 1; b < t.count && t.border_count < kMaxBorders; ++b)
      if (t.neighbours[a].has(b)) {
        PatchBorder& border = t.borders[t.border_count++];
        border = PatchBorder();
        border.a = static_cast<std::uint8_t>(a);
        border.b = static_cast<std::uint8_t>(b);
      }
  }
  for (std::size_t i = 0; i < model.size; ++i)
    for (const std::uint16_t n : model.model->neighbours(i)) {
      if (n >= model.size || t.patch_of[n] == t.patch_of[i]) continue;
      const std::uint8_t a = std::min(t.patch_of[i], t.patch_of[n]),
                         b = std::max(t.patch_of[i], t.patch_of[n]);
      for (std::size_t k = first[a]; k < t.border_count && t.borders[k].a == a; ++k) {
        if (t.borders[k].b != b) continue;
        ++t.borders[k].edges;
        t.borders[k].centre += 0.5 * (rest(model, i) + rest(model, n));
        break;
      }
    }
  for (std::size_t k = 0; k < t.border_count; ++k) t.borders[k].centre /= t.borders[k].edges;
}

/// Weights fall with the distance to a patch's centre, to nothing at two patch radii.
PointBlend blend_of(const ModelTables& model, const PatchTables& t, std::size_t i) noexcept {
  const std::size_t own = t.patch_of[i];
  std::array<double, 4> weight{};
  PointBlend out;
  out.patch.fill(static_cast<std::uint8_t>(own));
  const Vector3 at = rest(model, i);
  for (std::size_t p = 0; p < t.count; ++p) {
    if (p != own && !t.neighbours[own].has(p)) continue;
    const double square = (at - t.centres[p]).squaredNorm() / (4 * t.radius * t.radius);
    double w = square < 1 ? (1 - square) * (1 - square) : 0;
    if (p == own) w += 1e-3;
    std::size_t place = 4;
    while (place > 0 && weight[place - 1] < w) --place;
    if (place == 4) continue;
    for (std::size_t j = 3; j > place; --j) {
      weight[j] = weight[j - 1];
      out.patch[j] = out.patch[j - 1];
    }
    weight[place] = w;
    out.patch[place] = static_cast<std::uint8_t>(p);
  }
  const double sum = weight[0] + weight[1] + weight[2] + weight[3];
  int left = 1 << PointBlend::kShift;
  for (std::size_t j = 3; j > 0; --j) {
    out.weight[j] = static_cast<std::uint8_t>(std::floor(weight[j] / sum * (1 << PointBlend::kShift) + 0.5));
    left -= out.weight[j];
  }
  out.weight[0] = static_cast<std::uint8_t>(left);
  return out;
}

}  // namespace

void PatchTables::lay_out(Workspace& workspace, std::size_t points) noexcept {
  patch_of = workspace.take<std::uint8_t>(points);
  blend = workspace.take<PointBlend>(points);
}

void PatchTables::start(const ModelTables& model, std::span<std::uint16_t> queue) noexcept {
  count = std::min(kMaxPatches, std::max<std::size_t>(1, model.size / kPointsEach));
  spread_from_seeds(model, queue, *this);
  sizes = {};
  for (std::size_t p = 0; p < count; ++p) centres[p] = Vector3::Zero();
  for (std::size_t i = 0; i < model.size; ++i) {
    ++sizes[patch_of[i]];
    centres[patch_of[i]] += rest(model, i);
  }
  for (std::size_t p = 0; p < count; ++p) centres[p] /= sizes[p];
  double square = 0;
  for (std::size_t i = 0; i < model.size; ++i)
    square += (rest(model, i) - centres[patch_of[i]]).squaredNorm();
  radius = std::sqrt(2 * square / static_cast<double>(model.size));  // of the disc of that spread
  find_borders(model, *this);
  for (std::size_t k = 0; k < border_count; ++k)
    borders[k].length = (centres[borders[k].a] - centres[borders[k].b]).norm();
  for (std::size_t i = 0; i < model.size; ++i) blend[i] = blend_of(model, *this, i);
}

}  // namespace pliant
