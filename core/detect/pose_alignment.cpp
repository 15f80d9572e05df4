#include "core/detect/pose_alignment.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "core/detect/solve6.hpp"

namespace pliant {

namespace {

constexpr float kSameNormal = 0.7071F;  // cos 45°
constexpr float kNear = 0.05F;          // metres; nearer points have no pixel
constexpr std::size_t kFewest = 12;     // points that hold a pose: twice its freedoms

constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

Lanes load(const float* from) noexcept {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

float sum(const Lanes& a) noexcept {
  return (a[0] + a[1]) + (a[2] + a[3]);
}

/// Point-to-plane rows of a block of points, an array an entry.
struct Rows {
  static constexpr std::size_t kMost = ProbePoints::kBlock;
  std::array<std::array<float, kMost>, 6> row;
  std::array<float, kMost> residual, weight;
  std::size_t count = 0;
};

/// Their normal equations, lane by lane.
struct LaneSums {
  std::array<Lanes, 21> a{};
  std::array<Lanes, 6> b{};
  Lanes weight{};

  void add(Rows& rows) noexcept {
    for (; rows.count % kLanes != 0; ++rows.count) {
      for (auto& entry : rows.row) entry[rows.count] = 0;
      rows.residual[rows.count] = rows.weight[rows.count] = 0;
    }
    for (std::size_t k = 0; k < rows.count; k += kLanes) {
      const Lanes w = load(&rows.weight[k]), r = load(&rows.residual[k]);
      std::array<Lanes, 6> row;
      for (std::size_t i = 0; i < 6; ++i) row[i] = load(&rows.row[i][k]);
      std::size_t n = 0;
      for (std::size_t i = 0; i < 6; ++i) {
        const Lanes scaled = w * row[i];
        for (std::size_t j = 0; j <= i; ++j) a[n++] += scaled * row[j];
        b[i] += scaled * r;
      }
      weight += w;
    }
    rows.count = 0;
  }

  [[nodiscard]] NormalEquations6 equations() const noexcept {
    std::array<float, 21> entries;
    std::array<float, 6> sides;
    for (std::size_t k = 0; k < 21; ++k) entries[k] = sum(a[k]);
    for (std::size_t k = 0; k < 6; ++k) sides[k] = sum(b[k]);
    return {entries, sides, sum(weight)};
  }
};

}  // namespace

double align_step(const ProbePoints& points, const DepthSnapshot& snapshot, std::size_t count, double reach,
                  RigidTransform& pose) noexcept {
  const Vector3 pivot = pose * points.centre();
  const Point3f about = to_point(pivot);
  const auto wide = static_cast<float>(reach);
  LaneSums sums;
  Rows rows;
  std::size_t held = 0;
  const auto hold = [&](const Point3f& p, const Point3f& n, float /*facing*/) {
    int u = 0, v = 0;
    if (p.z < kNear || !snapshot.project(p, u, v)) return;
    if (snapshot.depth(u, v) == 0) return;
    const Normal16& seen = snapshot.normal(u, v);
    const Point3f m = {static_cast<float>(seen.x) * (1.0F / 16384),
                       static_cast<float>(seen.y) * (1.0F / 16384),
                       static_cast<float>(seen.z) * (1.0F / 16384)};
    if (dot(m, n) < kSameNormal) return;  // also where there is no normal
    const Point3f q = snapshot.vertex(u, v);
    const Point3f gap = {q.x - p.x, q.y - p.y, q.z - p.z};
    const float residual = dot(gap, m);
    const float most = wide + 3 * sigma_at(snapshot.sensor(), p.z);
    if (std::fabs(residual) > most) return;
    const float ratio = residual / most;
    const Point3f a = {p.x - about.x, p.y - about.y, p.z - about.z};
    const std::size_t k = rows.count++;
    rows.row[0][k] = a.y * m.z - a.z * m.y;
    rows.row[1][k] = a.z * m.x - a.x * m.z;
    rows.row[2][k] = a.x * m.y - a.y * m.x;
    rows.row[3][k] = m.x;
    rows.row[4][k] = m.y;
    rows.row[5][k] = m.z;
    rows.residual[k] = residual;
    rows.weight[k] = (1 - ratio * ratio) * (1 - ratio * ratio);
    ++held;
    if (rows.count == Rows::kMost) sums.add(rows);
  };
  const std::size_t facing = points.visit_facing(FastTransform(pose), count, hold);
  sums.add(rows);
  if (held < kFewest) return -1;
  const NormalEquations6 equations = sums.equations();
  Vector3 turn, shift;
  // Directions that the surface does not hold stay put: damped against the model's size.
  if (!equations.solve(1e-3 * points.radius() * points.radius(), 1e-3, turn, shift)) return -1;
  const Matrix3 rotation = rotation_from_small_vector(turn);
  pose.rotation = orthonormalised(rotation * pose.rotation);
  pose.translation = rotation * (pose.translation - pivot) + pivot + shift;
  return equations.weight() / static_cast<double>(facing);
}

int align_pose(const ProbePoints& points, const DepthSnapshot& snapshot, std::size_t count,
               const AlignSchedule& schedule, RigidTransform& pose) noexcept {
  for (int step = 0; step < schedule.steps; ++step)
    if (align_step(points, snapshot, count, schedule.reach(step), pose) < 0) return step + 1;
  return schedule.steps;
}

}  // namespace pliant
