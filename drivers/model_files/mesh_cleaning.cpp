#include "drivers/model_files/mesh_cleaning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace pliant {

namespace {

constexpr double kWeldShare = 1e-5;      // of the bounding box's diagonal
constexpr double kMostWelded = 0.05e-3;  // metres
constexpr std::uint32_t kGone = 0xFFFFFFFFU;

Vector3 scaled(const Point3f& p, double factor) {
  return to_vector(p) * factor;
}

/// Cells twice the tolerance wide: the tolerance around a point reaches into eight of them at most, and a
/// cell holds few vertices that lie farther apart than the tolerance.
class Welder {
 public:
  Welder(const Vector3& origin, double tolerance) : origin_(origin), tolerance_(tolerance) {}

  /// Index of the vertex within the tolerance of `p`, of several the first made; a new one when there is
  /// none.
  std::uint32_t add(const Vector3& p, std::vector<Vector3>& vertices) {
    const std::array<std::int64_t, 3> cell = cell_of(p);
    std::uint32_t found = kGone;
    const std::array<std::int64_t, 3> low = cell_of(p - Vector3::Constant(tolerance_));
    const std::array<std::int64_t, 3> high = cell_of(p + Vector3::Constant(tolerance_));
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
          found = std::min(found, find({x, y, z}, p, vertices));
    if (found != kGone) return found;
    const auto index = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(p);
    const auto [place, is_new] = first_.try_emplace(cell, index);
    next_.push_back(is_new ? kGone : place->second);
    place->second = index;
    return index;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<std::int64_t, 3>& cell) const {
      std::uint64_t hash = 0x9e3779b97f4a7c15U;
      for (const std::int64_t part : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(part)) * 0xff51afd7ed558ccdU;
        hash ^= hash >> 32;
      }
      return static_cast<std::size_t>(hash);
    }
  };
  [[nodiscard]] std::array<std::int64_t, 3> cell_of(const Vector3& p) const {
    std::array<std::int64_t, 3> cell{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      cell[i] = static_cast<std::int64_t>(std::floor((p(axis) - origin_(axis)) / (2 * tolerance_)));
    }
    return cell;
  }
  [[nodiscard]] std::uint32_t find(const std::array<std::int64_t, 3>& cell, const Vector3& p,
                                   const std::vector<Vector3>& vertices) const {
    const auto place = first_.find(cell);
    std::uint32_t found = kGone;
    for (std::uint32_t i = place == first_.end() ? kGone : place->second; i != kGone; i = next_[i])
      if ((vertices[i] - p).squaredNorm() <= tolerance_ * tolerance_) found = std::min(found, i);
    return found;
  }

  Vector3 origin_;
  double tolerance_;
  std::unordered_map<std::array<std::int64_t, 3>, std::uint32_t, Hash> first_;  // newest vertex of a cell
  std::vector<std::uint32_t> next_;                                             // older one of the same cell
};

/// Without area: two corners are one, or its height is less than a millionth of its longest side.
bool degenerate(const Mesh& mesh, const Triangle& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).squaredNorm());
  return !(area_vector(mesh, t).norm() > 1e-6 * longest);
}

/// Keeps the first of triangles with the same three vertices, whichever way they are wound.
void drop_doubles(std::vector<Triangle>& triangles) {
  struct Keyed {
    Triangle key;
    std::uint32_t index;
  };
  std::vector<Keyed> keyed(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    keyed[i] = {triangles[i], i};
    std::sort(keyed[i].key.begin(), keyed[i].key.end());
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return a.key != b.key ? a.key < b.key : a.index < b.index;
  });
  std::vector<bool> doubled(triangles.size(), false);
  for (std::size_t i = 1; i < keyed.size(); ++i) doubled[keyed[i].index] = keyed[i].key == keyed[i - 1].key;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (!doubled[i]) triangles[kept++] = triangles[i];
  triangles.resize(kept);
}

/// Drops vertices of no triangle.
void drop_loose_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> place(mesh.vertices.size(), kGone);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t corner : t) place[corner] = 0;
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] == kGone) continue;
    mesh.vertices[kept] = mesh.vertices[i];
    if (!mesh.given_normals.empty()) mesh.given_normals[kept] = mesh.given_normals[i];
    place[i] = kept++;
  }
  mesh.vertices.resize(kept);
  if (!mesh.given_normals.empty()) mesh.given_normals.resize(kept);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& corner : t) corner = place[corner];
}

/// Vertices that no triangle of the input has, not even one without area. `place`: where each was welded to.
std::size_t count_loose(const Geometry& geometry, const std::vector<std::uint32_t>& place,
                        std::size_t welded) {
  std::vector<bool> used(welded);
  for (const Triangle& t : geometry.triangles)
    for (const std::uint32_t corner : t) used[place[corner]] = true;
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
}

}  // namespace

Mesh clean_mesh(const Geometry& geometry, double metres_per_unit, std::vector<std::string>& warnings) {
  Mesh mesh;
  if (geometry.vertices.empty()) return mesh;
  Vector3 lowest = scaled(geometry.vertices[0], metres_per_unit), highest = lowest;
  for (const Point3f& p : geometry.vertices) {
    lowest = lowest.cwiseMin(scaled(p, metres_per_unit));
    highest = highest.cwiseMax(scaled(p, metres_per_unit));
  }
  Welder welder(lowest, std::clamp(kWeldShare * (highest - lowest).norm(), 1e-30, kMostWelded));
  std::vector<std::uint32_t> place(geometry.vertices.size());
  for (std::size_t i = 0; i < geometry.vertices.size(); ++i)
    place[i] = welder.add(scaled(geometry.vertices[i], metres_per_unit), mesh.vertices);
  if (!geometry.normals.empty()) {
    mesh.given_normals.assign(mesh.vertices.size(), Vector3::Zero());
    for (std::size_t i = 0; i < place.size(); ++i)
      mesh.given_normals[place[i]] += unit_or_zero(scaled(geometry.normals[i], 1));
    for (Vector3& normal : mesh.given_normals) normal = unit_or_zero(normal);
  }

  mesh.triangles.reserve(geometry.triangles.size());
  for (const Triangle& t : geometry.triangles) {
    const Triangle welded = {place[t[0]], place[t[1]], place[t[2]]};
    if (!degenerate(mesh, welded)) mesh.triangles.push_back(welded);
  }
  drop_doubles(mesh.triangles);
  if (!geometry.triangles.empty() && mesh.triangles.empty())
    warnings.push_back("none of the triangles has an area: the vertices are taken as a cloud");
  if (!mesh.triangles.empty()) {
    const std::size_t loose = count_loose(geometry, place, mesh.vertices.size());
    if (loose > 0)
      warnings.push_back(fmt::format("{} of no triangle {} left out",
                                     loose == 1 ? "1 vertex" : fmt::format("{} vertices", loose),
                                     loose == 1 ? "is" : "are"));
    drop_loose_vertices(mesh);
  }
  if (geometry.dropped > 0)
    warnings.push_back(fmt::format("{} points without finite coordinates are left out", geometry.dropped));
  return mesh;
}

}  // namespace pliant
