#include "core/track/track_state.hpp"

#include <algorithm>

namespace pliant {

int count_alive(const RegionSet& regions) noexcept {
  return static_cast<int>(
      std::count_if(regions.begin(), regions.end(), [](const TrackedRegion& r) { return r.alive; }));
}

RegionPoses fixed_poses(const RegionSet& regions, const Vector3& centre) noexcept {
  RegionPoses poses{};
  for (std::size_t k = 0; k < regions.size(); ++k)
    if (regions[k].alive) poses[k] = FixedPose(regions[k].pose, centre);
  return poses;
}

void PointState::lay_out(Workspace& workspace, std::size_t points) noexcept {
  home = workspace.take<std::int8_t>(points);
  evidence = workspace.take<std::uint8_t>(points);
  switching = workspace.take<std::uint8_t>(points);
  rival = workspace.take<std::int8_t>(points);
  sight = workspace.take<Sight>(points);
  label = workspace.take<std::int8_t>(points);
  match = workspace.take<std::int32_t>(points);
  residual = workspace.take<std::int32_t>(points);
  misfit = workspace.take<std::int32_t>(points);
  position = workspace.take<IntPoint>(points);
  offset = workspace.take<IntPoint>(points);
  group = workspace.take<std::int32_t>(points);
  queue = workspace.take<std::uint16_t>(points);
  correspondences = workspace.take<Correspondence>(points);
}

void PointState::reset() noexcept {
  std::fill(home.begin(), home.end(), std::int8_t{0});
  std::fill(evidence.begin(), evidence.end(), std::uint8_t{0});
  std::fill(switching.begin(), switching.end(), std::uint8_t{0});
  std::fill(rival.begin(), rival.end(), std::int8_t{-1});
  std::fill(sight.begin(), sight.end(), Sight::none);
  std::fill(label.begin(), label.end(), kNotObserved);
  std::fill(match.begin(), match.end(), -1);
  std::fill(residual.begin(), residual.end(), 0);
  std::fill(misfit.begin(), misfit.end(), 0);
  std::fill(position.begin(), position.end(), IntPoint{});
  std::fill(offset.begin(), offset.end(), IntPoint{});
  correspondence_count = 0;
  frames = 0;
}

void PointMemory::lay_out(Workspace& workspace, std::size_t points) noexcept {
  home = workspace.take<std::int8_t>(points);
  rival = workspace.take<std::int8_t>(points);
  evidence = workspace.take<std::uint8_t>(points);
  switching = workspace.take<std::uint8_t>(points);
  sight = workspace.take<Sight>(points);
  misfit = workspace.take<std::int32_t>(points);
  offset = workspace.take<IntPoint>(points);
}

void PointMemory::keep(const PointState& points) noexcept {
  std::copy(points.home.begin(), points.home.end(), home.begin());
  std::copy(points.rival.begin(), points.rival.end(), rival.begin());
  std::copy(points.evidence.begin(), points.evidence.end(), evidence.begin());
  std::copy(points.switching.begin(), points.switching.end(), switching.begin());
  std::copy(points.sight.begin(), points.sight.end(), sight.begin());
  std::copy(points.misfit.begin(), points.misfit.end(), misfit.begin());
  std::copy(points.offset.begin(), points.offset.end(), offset.begin());
  frames = points.frames;
}

void PointMemory::give_back(PointState& points) const noexcept {
  std::copy(home.begin(), home.end(), points.home.begin());
  std::copy(rival.begin(), rival.end(), points.rival.begin());
  std::copy(evidence.begin(), evidence.end(), points.evidence.begin());
  std::copy(switching.begin(), switching.end(), points.switching.begin());
  std::copy(sight.begin(), sight.end(), points.sight.begin());
  std::copy(misfit.begin(), misfit.end(), points.misfit.begin());
  std::copy(offset.begin(), offset.end(), points.offset.begin());
  points.frames = frames;
}

}  // namespace pliant
