#include "core/registration/cloud_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/registration/chain_measures.hpp"
#include "core/registration/region_search.hpp"

namespace pliant {

namespace {

constexpr std::size_t kSpeck = 6;  // points: fewer off their surroundings are noise

}  // namespace

void build_chain(RegistrationState& s, const RigidTransform& first, InstanceBuffers& buffers,
                 InstanceResult& instance) noexcept {
  const std::size_t n = s.model.size();
  std::array<RigidTransform, limits::kMaxRegions> poses;
  std::size_t regions = 1;
  poses[0] = first;
  measure(s, first, 0, false);
  const double noise = scene_noise(s);
  refine(s, s.prefix.first(std::min(kFinePoints, n)), noise, poses[0]);
  measure(s, poses[0], noise, false);
  std::uint32_t explained = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool on = on_surface(off_surface(s, i, noise));
    buffers.labels[i] = on ? std::int8_t{0} : kNotObserved;
    s.open[i] = on ? 0 : 1;
    explained += on ? 1 : 0;
  }
  take_points(s, buffers, 0, poses[0], noise);
  // The same again on the outliers.
  while (regions < s.settings.max_regions &&
         static_cast<double>(explained) < s.settings.wanted_share * static_cast<double>(n)) {
    if (!find_region(s, buffers, {poses.data(), regions}, noise, poses[regions])) break;
    const auto label = static_cast<std::int8_t>(regions);
    for (std::size_t i = 0; i < n; ++i)
      if (s.proposal[i] != 0) {
        explained += s.open[i];
        buffers.labels[i] = label;
        s.open[i] = 0;
      }
    take_points(s, buffers, label, poses[regions], noise);
    ++regions;
  }
  if (regions > 1) settle_borders(s, buffers, {poses.data(), regions}, noise);
  // Specks within a region that miss its bound by little are its own: noise.
  measure(s, poses[0], noise, false);
  for (std::size_t i = 0; i < n; ++i) s.off[i] = off_surface(s, i, noise);
  s.islands.filter(s.model, kSpeck, buffers.labels, [&](std::size_t i, std::int8_t label) {
    return label == 0 && buffers.labels[i] < 0 && s.off[i] < 1.5F;
  });
  // The largest region is the base.
  std::array<std::uint32_t, limits::kMaxRegions> sizes{};
  for (std::size_t i = 0; i < n; ++i)
    if (buffers.labels[i] >= 0) ++sizes[static_cast<std::size_t>(buffers.labels[i])];
  std::array<std::int8_t, limits::kMaxRegions> rank{}, number{};
  for (std::size_t r = 0; r < regions; ++r) rank[r] = static_cast<std::int8_t>(r);
  std::sort(
      rank.begin(), rank.begin() + static_cast<std::ptrdiff_t>(regions), [&](std::int8_t a, std::int8_t b) {
        const std::uint32_t x = sizes[static_cast<std::size_t>(a)], y = sizes[static_cast<std::size_t>(b)];
        return x != y ? x > y : a < b;
      });
  for (std::size_t k = 0; k < regions; ++k)
    number[static_cast<std::size_t>(rank[k])] = static_cast<std::int8_t>(k);
  for (std::size_t i = 0; i < n; ++i)
    if (buffers.labels[i] >= 0) buffers.labels[i] = number[static_cast<std::size_t>(buffers.labels[i])];
  for (std::size_t k = 0; k < regions; ++k) {
    RegionResult& region = buffers.regions[k];
    region = RegionResult();
    region.id = static_cast<std::int8_t>(k);
    region.transform = poses[static_cast<std::size_t>(rank[k])];
  }
  instance.regions = buffers.regions.first(regions);
  for (std::size_t k = 0; k < regions; ++k) {
    RegionResult& region = buffers.regions[k];
    measure(s, region.transform, noise, false);
    for (std::size_t i = 0; i < n; ++i) {
      if (buffers.labels[i] != region.id) continue;
      s.gap_nearest[i] = s.readings.nearest(i);
      buffers.residuals[i] = s.readings.distance(i);
      const SurfaceGap gap = s.readings.gap(s.model, i);
      ++region.points;
      region.rms += static_cast<double>(gap.along * gap.along);
    }
  }
  for (std::size_t k = 0; k < regions; ++k)
    if (buffers.regions[k].points > 0)
      buffers.regions[k].rms = std::sqrt(buffers.regions[k].rms / buffers.regions[k].points);
}

}  // namespace pliant
