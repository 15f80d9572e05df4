// Written so that the compiler makes vectors of the loops: no jumps, choices between values at hand.
#include "core/detect/match_lanes.hpp"

#include <cmath>

namespace pliant {

namespace {

float length(float x, float y, float z) noexcept {
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

std::uint32_t MatchLanes::consistent_with(std::size_t seed, float tolerance,
                                          std::span<std::int32_t> hits) const noexcept {
  const float *px = mx.data(), *py = my.data(), *pz = mz.data();
  const float *qx = sx.data(), *qy = sy.data(), *qz = sz.data();
  const float x = px[seed], y = py[seed], z = pz[seed], u = qx[seed], v = qy[seed], w = qz[seed];
  std::int32_t* hit = hits.data();
  std::int32_t sum = 0;
  const std::size_t count = hits.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float off = length(px[i] - x, py[i] - y, pz[i] - z) - length(qx[i] - u, qy[i] - v, qz[i] - w);
    hit[i] = std::fabs(off) <= tolerance ? 1 : 0;
    sum += hit[i];
  }
  return static_cast<std::uint32_t>(sum);
}

std::uint32_t MatchLanes::count_agreeing(std::size_t seed, const FastTransform& pose, float tolerance,
                                         float growth, std::size_t count) const noexcept {
  const float *px = mx.data(), *py = my.data(), *pz = mz.data();
  const float *qx = sx.data(), *qy = sy.data(), *qz = sz.data();
  const float x = px[seed], y = py[seed], z = pz[seed], u = qx[seed], v = qy[seed], w = qz[seed];
  const float *r = pose.r, *t = pose.t;
  std::int32_t sum = 0;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float in_model = length(px[i] - x, py[i] - y, pz[i] - z);
    const float in_scene = length(qx[i] - u, qy[i] - v, qz[i] - w);
    const float ox = r[0] * px[i] + r[1] * py[i] + r[2] * pz[i] + t[0] - qx[i];
    const float oy = r[3] * px[i] + r[4] * py[i] + r[5] * pz[i] + t[1] - qy[i];
    const float oz = r[6] * px[i] + r[7] * py[i] + r[8] * pz[i] + t[2] - qz[i];
    const float limit = tolerance + growth * in_model;
    const std::int32_t kept = std::fabs(in_model - in_scene) <= tolerance ? 1 : 0;
    const std::int32_t near = ox * ox + oy * oy + oz * oz <= limit * limit ? 1 : 0;
    sum += kept & near;
  }
  return static_cast<std::uint32_t>(sum);
}

void MatchLanes::explained_by(const FastTransform& pose, const Point3f& around, float tolerance, float growth,
                              std::span<std::int32_t> hits) const noexcept {
  const float *px = mx.data(), *py = my.data(), *pz = mz.data();
  const float *qx = sx.data(), *qy = sy.data(), *qz = sz.data();
  const float *r = pose.r, *t = pose.t;
  std::int32_t* hit = hits.data();
  const std::size_t count = hits.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float ox = r[0] * px[i] + r[1] * py[i] + r[2] * pz[i] + t[0] - qx[i];
    const float oy = r[3] * px[i] + r[4] * py[i] + r[5] * pz[i] + t[1] - qy[i];
    const float oz = r[6] * px[i] + r[7] * py[i] + r[8] * pz[i] + t[2] - qz[i];
    const float limit = tolerance + growth * length(px[i] - around.x, py[i] - around.y, pz[i] - around.z);
    hit[i] = ox * ox + oy * oy + oz * oz <= limit * limit ? 1 : 0;
  }
}

}  // namespace pliant
