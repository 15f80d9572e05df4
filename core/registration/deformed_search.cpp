#include "core/registration/deformed_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/fast_transform.hpp"
#include "core/registration/chain_measures.hpp"
#include "core/registration/cloud_warp.hpp"

namespace pliant {

void find_deformed(RegistrationState& s, InstanceBuffers& buffers, InstanceResult& instance) noexcept {
  const std::size_t n = s.model.size();
  if (s.settings.warp) warp_cloud(s, buffers);
  // Every point starts where the nearest region (along the model's surface) takes it.
  for (std::size_t i = 0; i < n; ++i)
    s.proposal[i] =
        buffers.labels[i] >= 0 ? static_cast<std::uint32_t>(buffers.labels[i]) : limits::kMaxRegions;
  for (int sweep = 0; sweep < 64; ++sweep) {
    bool changed = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (s.proposal[i] != limits::kMaxRegions) continue;
      for (const std::uint16_t j : s.model.neighbours(i))
        if (j != kNoNeighbour && s.proposal[j] != limits::kMaxRegions) {
          s.proposal[i] = s.proposal[j];
          changed = true;
          break;
        }
    }
    if (!changed) break;
  }
  const auto radius = static_cast<float>(std::max(8 * s.spacing, 0.15 * s.model.radius()));
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t region = s.proposal[i] == limits::kMaxRegions ? 0 : s.proposal[i];
    const FastTransform fast(buffers.regions[region].transform);
    if (!s.settings.warp) buffers.positions[i] = fast.point(s.model.positions()[i]);
    buffers.matches[i] = -1;
    if (buffers.labels[i] >= 0) {
      buffers.matches[i] = s.gap_nearest[i] == PointGrid::kNone
                               ? -1
                               : static_cast<std::int32_t>(s.base_index[s.gap_nearest[i]]);
      continue;
    }
    buffers.residuals[i] = 0;
  }
  // Each point without a match asks for its nearest free scene point whose surface faces its way; of several
  // that ask for one, the nearest gets it, and the others ask again.
  for (std::size_t j = 0; j < s.base_count; ++j) s.claimed[j] = 0;
  for (std::size_t i = 0; i < n; ++i) s.gap_nearest[i] = PointGrid::kNone;
  const Point3f eye = to_point(s.eye);
  const auto working_reach_f = static_cast<float>(2 * working_reach(s));
  for (int pass = 0; pass < 6; ++pass) {
    bool asked = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (buffers.labels[i] >= 0 || s.gap_nearest[i] != PointGrid::kNone) continue;
      const std::size_t region = s.proposal[i] == limits::kMaxRegions ? 0 : s.proposal[i];
      const Point3f normal = FastTransform(buffers.regions[region].transform).direction(s.model.normals()[i]);
      const Point3f& p = buffers.positions[i];
      // What is turned away from the only eye cannot be seen.
      if (s.one_view && normal.x * (eye.x - p.x) + normal.y * (eye.y - p.y) + normal.z * (eye.z - p.z) <= 0)
        continue;
      float square = 0;
      const std::uint32_t j = s.base_grid.nearest_if(p, radius, square, [&](std::uint32_t k) {
        if (s.base_taken[k] != 0) return false;
        if (s.claimed[k] != 0) {
          const Point3f& q = buffers.positions[s.claimed[k] - 1];
          const Point3f& t = s.base[k];
          const float theirs =
              (q.x - t.x) * (q.x - t.x) + (q.y - t.y) * (q.y - t.y) + (q.z - t.z) * (q.z - t.z);
          const float mine =
              (p.x - t.x) * (p.x - t.x) + (p.y - t.y) * (p.y - t.y) + (p.z - t.z) * (p.z - t.z);
          if (mine >= theirs) return false;
        }
        float w = 0;
        const std::uint32_t near = s.working_grid.nearest(s.base[k], working_reach_f, w);
        if (near == PointGrid::kNone) return false;
        const Normal16& m = s.working_normals[near];
        return normal.x * static_cast<float>(m.x) + normal.y * static_cast<float>(m.y) +
                   normal.z * static_cast<float>(m.z) >
               0.5F * 16384;
      });
      if (j == PointGrid::kNone) continue;
      if (s.claimed[j] != 0) s.gap_nearest[s.claimed[j] - 1] = PointGrid::kNone;
      s.claimed[j] = static_cast<std::uint32_t>(i + 1);
      s.gap_nearest[i] = j;
      asked = true;
    }
    if (!asked) break;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (buffers.labels[i] >= 0) continue;
    buffers.labels[i] = s.gap_nearest[i] == PointGrid::kNone ? kNotObserved : kDeformed;
    if (s.gap_nearest[i] == PointGrid::kNone) continue;
    const Point3f& q = s.base[s.gap_nearest[i]];
    const Point3f& p = buffers.positions[i];
    buffers.residuals[i] =
        std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y) + (q.z - p.z) * (q.z - p.z));
    // The warp knows better than a noisy point beside it where this point went.
    if (!s.settings.warp) buffers.positions[i] = q;
    buffers.matches[i] = static_cast<std::int32_t>(s.base_index[s.gap_nearest[i]]);
  }
  // What the deformed points were matched with belongs to this instance too.
  for (std::size_t j = 0; j < s.base_count; ++j)
    if (s.claimed[j] != 0) s.base_taken[j] = 1;
  for (std::size_t j = 0; j < s.base_count; ++j)
    if (s.base_taken[j] != 0) s.base_taken[j] = 3;
  for (std::size_t j = 0; j < s.working_count; ++j) {
    float square = 0;
    const std::uint32_t i = s.base_grid.nearest(s.working[j], static_cast<float>(s.spacing), square);
    if (i != PointGrid::kNone && s.base_taken[i] != 0) s.working_taken[j] = 1;
  }
  instance.positions = buffers.positions;
  instance.labels = buffers.labels;
  instance.matches = buffers.matches;
  instance.residuals = buffers.residuals;
  instance.deformed = instance.unobserved = 0;
  for (const std::int8_t label : buffers.labels) {
    instance.deformed += label == kDeformed ? 1 : 0;
    instance.unobserved += label == kNotObserved ? 1 : 0;
  }
}

}  // namespace pliant
