#include "core/registration/normal_estimation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/detect/symmetric_eigen.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMostNeighbours = 512;
constexpr std::size_t kFewNeighbours = 8;

std::int16_t to_q14(double x) noexcept {
  return static_cast<std::int16_t>(std::floor(x * 16384.0 + 0.5));
}

float dot(const Normal16& n, const Point3f& p) noexcept {
  return (static_cast<float>(n.x) * p.x + static_cast<float>(n.y) * p.y + static_cast<float>(n.z) * p.z) *
         (1.0F / 16384);
}

std::int32_t dot(const Normal16& a, const Normal16& b) noexcept {  // Q28
  return std::int32_t{a.x} * b.x + std::int32_t{a.y} * b.y + std::int32_t{a.z} * b.z;
}

void add(Point3f& sum, const Point3f& p) noexcept {
  sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
}

void scale(Point3f& p, float s) noexcept {
  p = {p.x * s, p.y * s, p.z * s};
}

constexpr float kOwnShape = 0.1F;  // flux against that of a sphere of the same reach

void flip(Normal16& n) noexcept {
  n = {static_cast<std::int16_t>(-n.x), static_cast<std::int16_t>(-n.y), static_cast<std::int16_t>(-n.z), 0};
}

}  // namespace

namespace {

/// The spread of points around their mean, in units of the reach squared.
struct Spread {
  SymmetricEigen eigen;
  std::size_t count = 0;
  /// Spans a plane, not only a line.
  [[nodiscard]] bool tells() const noexcept { return count >= 3 && eigen.values(1) > 1e-4 * eigen.values(2); }
};

/// The points around one, as offsets from it.
struct Surroundings {
  static constexpr std::size_t kLanes = 4;
  static constexpr std::size_t kRoom = kMostNeighbours + kLanes;
  float x[kRoom], y[kRoom], z[kRoom], square[kRoom];
  std::uint32_t index[kRoom];
  std::size_t count = 0;

  void gather(const PointGrid& grid, const Point3f& c, float reach) noexcept {
    count = grid.gather_within(c, reach, kMostNeighbours, {x, y, z, square, index});
    for (std::size_t k = count; k < count + kLanes; ++k) x[k] = y[k] = z[k] = 0;
    for (std::size_t k = count; k < count + kLanes; ++k) square[k] = std::numeric_limits<float>::max();
  }
  /// Keeps distances and numbers of the points after number i and before `end`; returns how many.
  [[nodiscard]] std::size_t keep_after(std::uint32_t i, std::size_t end) noexcept {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t j = index[k];
      square[kept] = square[k];
      index[kept] = j;
      kept += static_cast<std::size_t>(j > i) & static_cast<std::size_t>(j < end);
    }
    return kept;
  }
  /// Of those within `reach`, at most that of gather(). Lane by lane: the same sums whatever the vectors.
  [[nodiscard]] Spread spread(float reach) const noexcept;
};

Spread Surroundings::spread(float reach) const noexcept {
  float sums[10][kLanes] = {};
  const float unit = 1 / reach, limit = reach * reach;
  for (std::size_t k = 0; k < count; k += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float one = square[k + l] <= limit ? 1.0F : 0.0F, scale = square[k + l] <= limit ? unit : 0.0F;
      const float px = x[k + l] * scale, py = y[k + l] * scale, pz = z[k + l] * scale;
      sums[0][l] += px;
      sums[1][l] += py;
      sums[2][l] += pz;
      sums[3][l] += px * px;
      sums[4][l] += px * py;
      sums[5][l] += px * pz;
      sums[6][l] += py * py;
      sums[7][l] += py * pz;
      sums[8][l] += pz * pz;
      sums[9][l] += one;
    }
  double sum[10];
  for (int i = 0; i < 10; ++i)
    sum[i] = static_cast<double>(sums[i][0]) + static_cast<double>(sums[i][1]) +
             static_cast<double>(sums[i][2]) + static_cast<double>(sums[i][3]);
  Spread spread;
  spread.count = static_cast<std::size_t>(sum[9]);
  if (spread.count < 3) return spread;
  const double k = 1.0 / sum[9], mx = sum[0] * k, my = sum[1] * k, mz = sum[2] * k;
  Matrix3 m;
  m(0, 0) = sum[3] * k - mx * mx;
  m(0, 1) = m(1, 0) = sum[4] * k - mx * my;
  m(0, 2) = m(2, 0) = sum[5] * k - mx * mz;
  m(1, 1) = sum[6] * k - my * my;
  m(1, 2) = m(2, 1) = sum[7] * k - my * mz;
  m(2, 2) = sum[8] * k - mz * mz;
  spread.eigen = symmetric_eigen(m);
  return spread;
}

// Where the points leave their plane by more than this share of their spread, they may be bent.
constexpr double kPerhapsBent = 0.02;
constexpr float kNarrow = 0.55F;
// Noise leaves the plane by as much however near the points are, a bend by the fourth power of how near: half
// way between.
constexpr double kBent = 0.4;

}  // namespace

void estimate_normals(const PointGrid& grid, std::span<const Point3f> at, double radius,
                      std::span<Normal16> normals) noexcept {
  Surroundings around;
  for (std::size_t i = 0; i < at.size(); ++i) {
    normals[i] = Normal16();
    for (int attempt = 0; attempt < 3; ++attempt) {
      const auto reach = static_cast<float>(radius * (1 << attempt));
      around.gather(grid, at[i], reach);
      Spread spread = around.spread(reach);
      if (spread.count < kFewNeighbours && attempt < 2) continue;
      if (spread.count < 3) break;
      if (!spread.tells()) continue;  // on a line
      // A limb is thinner than the reach that averages noise away on a broad surface.
      if (attempt == 0 && spread.eigen.values(0) > kPerhapsBent * spread.eigen.values(2)) {
        const Spread narrow = around.spread(kNarrow * reach);
        if (narrow.count >= kFewNeighbours && narrow.tells() &&
            static_cast<double>(kNarrow * kNarrow) * narrow.eigen.values(0) < kBent * spread.eigen.values(0))
          spread = narrow;
      }
      const Vector3 normal = spread.eigen.vectors.col(0);
      normals[i] = {to_q14(normal.x()), to_q14(normal.y()), to_q14(normal.z()), 0};
      break;
    }
  }
}

void NormalOrientation::lay_out(Workspace& workspace, std::size_t capacity) noexcept {
  edges_ = workspace.take<Edge>(capacity * kEdges);
  sorted_ = workspace.take<Edge>(capacity * kEdges);
  keys_ = workspace.take<std::uint8_t>(capacity * kEdges);
  parent_ = workspace.take<std::uint32_t>(capacity);
  parity_ = workspace.take<std::uint8_t>(capacity);
  pieces_ = workspace.take<Piece>(capacity);
}

void NormalOrientation::towards(std::span<const Point3f> points, const Point3f& viewpoint,
                                std::span<Normal16> normals) noexcept {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f to = {viewpoint.x - points[i].x, viewpoint.y - points[i].y, viewpoint.z - points[i].z};
    if (dot(normals[i], to) < 0) flip(normals[i]);
  }
}

std::uint32_t NormalOrientation::root(std::uint32_t i, bool& flipped) noexcept {
  // Path halving keeps the forest flat; parities add up along the way.
  bool odd = false;
  while (parent_[i] != i) {
    const std::uint32_t p = parent_[i];
    if (parent_[p] != p) {
      parity_[i] = static_cast<std::uint8_t>(parity_[i] ^ parity_[p]);
      parent_[i] = parent_[p];
    }
    odd = odd != (parity_[i] != 0);
    i = parent_[i];
  }
  flipped = odd;
  return i;
}

void NormalOrientation::outward(std::span<const Point3f> points, const PointGrid& grid, double reach,
                                std::span<Normal16> normals) noexcept {
  const std::size_t count = std::min(points.size(), parent_.size());
  constexpr std::int32_t kOne = 1 << 28;
  std::size_t edges = 0;
  std::uint32_t histogram[257] = {};
  Surroundings around;
  for (std::uint32_t i = 0; i < count; ++i) {
    parent_[i] = i;
    parity_[i] = 0;
    // The kEdges nearest of higher number, by rising distance; each pair is met once.
    std::uint32_t near[kEdges] = {};
    float distance[kEdges] = {};
    std::size_t held = 0;
    around.gather(grid, points[i], static_cast<float>(reach));
    const std::size_t later = around.keep_after(i, count);
    for (std::size_t n = 0; n < later; ++n) {
      const float square = around.square[n];
      std::size_t k = held;
      if (held == kEdges) {
        if (square >= distance[kEdges - 1]) continue;
        k = kEdges - 1;
      } else {
        ++held;
      }
      for (; k > 0 && square < distance[k - 1]; --k) {
        distance[k] = distance[k - 1];
        near[k] = near[k - 1];
      }
      distance[k] = square;
      near[k] = around.index[n];
    }
    for (std::size_t k = 0; k < held; ++k) {
      const std::int32_t cosine = dot(normals[i], normals[near[k]]);
      const std::int32_t alike = cosine < 0 ? -cosine : cosine;
      if (alike < kOne / 2) continue;
      const std::int32_t key = (kOne - std::min(alike, kOne)) >> 19;  // 0 (parallel) … 255 (60°)
      keys_[edges] = static_cast<std::uint8_t>(std::min(key, 255));
      ++histogram[keys_[edges] + 1];
      edges_[edges++] = {i, near[k]};
    }
  }
  for (int k = 0; k < 256; ++k) histogram[k + 1] += histogram[k];
  for (std::size_t e = 0; e < edges; ++e) sorted_[histogram[keys_[e]]++] = edges_[e];
  for (std::size_t e = 0; e < edges; ++e) {
    const auto [a, b] = sorted_[e];
    bool odd_a = false, odd_b = false;
    const std::uint32_t root_a = root(a, odd_a), root_b = root(b, odd_b);
    if (root_a == root_b) continue;
    const bool opposite = dot(normals[a], normals[b]) < 0;
    parent_[root_b] = root_a;
    parity_[root_b] = static_cast<std::uint8_t>((odd_a != odd_b) != opposite ? 1 : 0);
  }
  // Centres, then the flux of each piece's normals from its centre.
  Point3f middle;
  for (std::uint32_t i = 0; i < count; ++i) pieces_[i] = Piece();
  for (std::uint32_t i = 0; i < count; ++i) {
    bool odd = false;
    Piece& piece = pieces_[root(i, odd)];
    if (odd) flip(normals[i]);
    add(piece.centre, points[i]);
    add(middle, points[i]);
    piece.size += 1;
  }
  if (count == 0) return;
  scale(middle, 1.0F / static_cast<float>(count));
  for (std::uint32_t i = 0; i < count; ++i)
    if (pieces_[i].size > 0) scale(pieces_[i].centre, 1.0F / pieces_[i].size);
  for (std::uint32_t i = 0; i < count; ++i) {
    bool odd = false;
    Piece& piece = pieces_[root(i, odd)];
    const Point3f from = {points[i].x - piece.centre.x, points[i].y - piece.centre.y,
                          points[i].z - piece.centre.z};
    const Point3f inward = {middle.x - points[i].x, middle.y - points[i].y, middle.z - points[i].z};
    piece.flux += dot(normals[i], from);
    piece.reach += std::sqrt(from.x * from.x + from.y * from.y + from.z * from.z);
    piece.lean += dot(normals[i], inward);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    bool odd = false;
    const Piece& piece = pieces_[root(i, odd)];
    // A sphere's flux is its mean distance from the centre times its size; a flat piece's is next to nothing.
    // It looks to the side where the rest of the scene stands.
    const bool own = std::fabs(piece.flux) > kOwnShape * piece.reach;
    if (own ? piece.flux < 0 : piece.lean < 0) flip(normals[i]);
  }
}

}  // namespace pliant
