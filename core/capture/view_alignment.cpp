#include "core/capture/view_alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/capture/weak_motions.hpp"
#include "core/track/associate.hpp"
#include "core/track/plane_equations.hpp"

namespace pliant {

namespace {

constexpr std::uint32_t kFewestRows = 60;
constexpr std::int32_t kCos60 = 8192;  // Q14
constexpr double kRowsOfOneReading =
    400;                         // noise is alike over neighbouring pixels: so many rows say as much as one
constexpr double kStill = 2e-5;  // metres, radians times 0.1 m: a step that changes nothing more

std::int32_t dot_q14(const IntPoint& a, const IntPoint& b) noexcept {
  return (a.x * b.x + a.y * b.y + a.z * b.z) >> 14;
}

struct Counts {
  std::size_t rows = 0;
  std::uint32_t against = 0, fresh = 0;
};

/// The integer kernel: where each point lies, and the rows of those on the known surface.
[[gnu::noinline]] Counts volume_rows(std::span<const ViewPoint> points, const DistanceVolume& volume,
                                     const FixedPose& model_from_camera, std::span<PlaneRow> rows) noexcept {
  Counts counts;
  for (const ViewPoint& p : points) {
    const IntPoint m = model_from_camera.point(p.x, p.y, p.z);
    if (!volume.holds(m)) continue;
    std::int32_t distance = 0;
    IntPoint gradient;
    if (!volume.sample(m, distance, gradient)) {
      ++(volume.stands_in_free_space({p.x, p.y, p.z}, model_from_camera) ? counts.against : counts.fresh);
      continue;
    }
    const IntPoint own = model_from_camera.direction(p.nx, p.ny, p.nz);
    if (dot_q14(gradient, own) < kCos60) {
      ++counts.against;
      continue;
    }
    rows[counts.rows++] = plane_row(m, gradient, own, -distance);
  }
  return counts;
}

Vector3 metres(const IntPoint& p) noexcept {
  return {p.x / kUnitsPerMetre, p.y / kUnitsPerMetre, p.z / kUnitsPerMetre};
}

/// Solves for the motion of the view in the model's frame, drawn to `predicted`. False when there is no
/// answer.
bool step(const RobustMoments& robust, PlaneEquations equations, const RigidTransform& predicted,
          const ViewAlignSettings& settings, RigidTransform& model_from_camera, Vector6& x) noexcept {
  if (robust.moments.rows < kFewestRows) return false;
  const Vector3 centre = metres(robust.centre);
  const Vector6 back = motion_between(predicted.inverse(), model_from_camera, centre);
  const double spread = robust.scale / kUnitsPerMetre;
  const double readings = 1 + robust.moments.rows / kRowsOfOneReading;
  for (int i = 0; i < 6; ++i) {
    const double sigma = i < 3 ? settings.prior_rotation : settings.prior_translation;
    const double information = readings * spread * spread / (sigma * sigma);
    equations.a(i, i) += information;
    equations.b[i] += information * back[i];
  }
  x = equations.a.ldlt().solve(equations.b);
  if (!(x.squaredNorm() < 1.0)) return false;  // also for not-a-number
  model_from_camera = motion_about(x, centre) * model_from_camera;
  model_from_camera.rotation = orthonormalised(model_from_camera.rotation);
  return true;
}

double radius_of(std::span<const PlaneRow> rows, const IntPoint& centre) noexcept {
  std::int64_t square = 0;
  for (const PlaneRow& row : rows) {
    const std::int64_t x = row.point.x - centre.x, y = row.point.y - centre.y, z = row.point.z - centre.z;
    square += x * x + y * y + z * z;
  }
  return std::sqrt(static_cast<double>(square) / static_cast<double>(rows.size())) / kUnitsPerMetre;
}

bool is_still(const Vector6& x) noexcept {
  return x.head<3>().cwiseAbs().maxCoeff() * 0.1 < kStill && x.tail<3>().cwiseAbs().maxCoeff() < kStill;
}

}  // namespace

ViewFit align_to_volume(std::span<const ViewPoint> points, const DistanceVolume& volume,
                        const RigidTransform& predicted, const ViewAlignSettings& settings,
                        std::span<PlaneRow> rows) noexcept {
  RigidTransform inverse = predicted.inverse();
  ViewFit fit;
  fit.pose = predicted;
  for (int i = 0; i <= settings.iterations; ++i) {
    const Counts counts = volume_rows(points, volume, FixedPose(inverse, Vector3::Zero()), rows);
    const auto used = rows.first(counts.rows);
    const RobustMoments robust = robust_moments(used, settings.noise);
    fit.agreeing = robust.moments.rows;
    fit.against = counts.against + static_cast<std::uint32_t>(counts.rows) - robust.moments.rows;
    fit.fresh = counts.fresh;
    if (robust.moments.weight > 0)
      fit.rms =
          std::sqrt(static_cast<double>(robust.moments.square) / static_cast<double>(robust.moments.weight)) *
          kResidualMetres;
    if (counts.rows == 0) break;
    const double radius = radius_of(used, robust.centre);
    const WeakMotions weak = weigh_weak_motions(used, robust, radius, settings.stands);
    Vector6 x;
    if (i < settings.iterations && step(robust, weak.equations, predicted, settings, inverse, x) &&
        !is_still(x))
      continue;
    fit.held = weak.held;
    fit.radius = radius;
    break;
  }
  fit.pose = inverse.inverse();
  return fit;
}

std::size_t pair_rows(std::span<const ViewPoint> points, const RigidTransform& pose,
                      const PosedPicture& other, const Projector& projector, const Surface& rays,
                      std::int32_t gate, std::span<PlaneRow> rows) noexcept {
  const RigidTransform model_from_camera = pose.inverse();
  const FixedPose to_model(model_from_camera, Vector3::Zero());
  const FixedPose to_other(other.pose * model_from_camera, Vector3::Zero());
  std::size_t count = 0;
  for (const ViewPoint& point : points) {
    const IntPoint p = to_other.point(point.x, point.y, point.z);
    const IntPoint n = to_other.direction(point.nx, point.ny, point.nz);
    int u = 0, v = 0;
    if (!faces_camera(p, n, kCos60) || !projector.project(p, u, v) || !other.picture.window.contains(u, v))
      continue;
    const std::size_t i = other.picture.index(u, v);
    if (other.picture.facing[i] == 0) continue;
    const IntPoint q = rays.vertex(u, v, other.picture.depth[i]);
    if (std::abs(q.z - p.z) > gate) continue;
    const IntPoint m = to_model.point(point.x, point.y, point.z);
    const IntPoint direction = to_model.direction(point.nx, point.ny, point.nz);
    rows[count++] = plane_row(m, direction, direction, plane_distance(q, p, n));
    if (count == rows.size()) break;
  }
  return count;
}

bool align_to_picture(std::span<const ViewPoint> points, const PosedPicture& other,
                      const Projector& projector, const Surface& rays, double gate,
                      const ViewAlignSettings& settings, std::span<PlaneRow> rows,
                      RigidTransform& pose) noexcept {
  const RigidTransform start = pose;
  RigidTransform inverse = pose.inverse();
  for (int i = 0; i < settings.iterations; ++i) {
    // Down to a quarter by the last step.
    const double narrowing = 1 - 0.75 * i / settings.iterations;
    const auto reach = static_cast<std::int32_t>(gate * narrowing * kUnitsPerMetre);
    const std::size_t count = pair_rows(points, inverse.inverse(), other, projector, rays, reach, rows);
    Vector6 x;
    const RobustMoments robust = robust_moments(rows.first(count), settings.noise);
    if (!step(robust, plane_equations(robust.moments), start, settings, inverse, x)) return false;
    if (is_still(x)) break;
  }
  pose = inverse.inverse();
  return true;
}

}  // namespace pliant
