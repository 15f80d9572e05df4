#include "core/registration/registration_layout.hpp"

#include <algorithm>
#include <new>

#include "core/registration/depth_search.hpp"

namespace pliant {

namespace {

/// Keypoints after every step of the sampling factor (−20 % each, so about 1.56 times as many).
std::size_t key_capacity(std::size_t scene_points, const RegistrationSettings& settings) noexcept {
  double keys = 1.1 * settings.scene_keypoints;
  for (std::uint32_t step = 0; step < settings.sampling_steps; ++step) keys *= 1.5625;
  return std::min({static_cast<std::size_t>(keys) + 64, scene_points, std::size_t{65535}});
}

RegistrationSettings clamped(const RegistrationSettings& given, const ModelView& model) noexcept {
  RegistrationSettings s = given;
  s.model_keypoints = std::clamp(s.model_keypoints, 32U, static_cast<std::uint32_t>(limits::kMaxModelPoints));
  s.model_keypoints = std::min(s.model_keypoints, static_cast<std::uint32_t>(model.size()));
  s.scene_keypoints = std::clamp(s.scene_keypoints, 32U, 65535U);
  s.sampling_steps = std::min(s.sampling_steps, 8U);
  s.max_regions = std::clamp(s.max_regions, 1U, static_cast<std::uint32_t>(limits::kMaxRegions));
  s.max_instances =
      std::clamp(s.max_instances, 1U, static_cast<std::uint32_t>(CloudRegistration::kMostInstances));
  s.workers = std::clamp(s.workers, 1U, kMostWorkers);
  s.wanted_share = std::clamp(s.wanted_share, 0.1, 1.0);
  return s;
}

}  // namespace

void lay_out(Workspace& workspace, const ModelView& model, std::size_t scene_points,
             const RegistrationSettings& given, RegistrationState& s) noexcept {
  s.settings = clamped(given, model);
  s.model = model;
  const std::size_t n = scene_points, m = model.size(), keys = key_capacity(n, s.settings);
  s.base = workspace.take<Point3f>(n);
  s.base_index = workspace.take<std::uint32_t>(n);
  s.base_taken = workspace.take<std::uint8_t>(n);
  s.working = workspace.take<Point3f>(n);
  s.working_normals = workspace.take<Normal16>(n);
  s.working_taken = workspace.take<std::uint8_t>(n);
  s.scratch = workspace.take<float>(std::max(n, m));
  s.kept = workspace.take<std::uint32_t>(n);
  s.base_grid.lay_out(workspace, n);
  s.working_grid.lay_out(workspace, n);
  s.sampling.lay_out(workspace, n);
  s.orientation.lay_out(workspace, n);
  s.keys = workspace.take<Point3f>(keys);
  s.key_descriptors = workspace.take<Descriptor>(keys);
  s.key_frames = workspace.take<LocalFrame>(keys);
  s.matches = workspace.take<Match>(keys);
  s.posed = workspace.take<PosedMatch>(keys);
  s.posed_left = workspace.take<PosedMatch>(keys);
  const std::size_t own =
      s.settings.model_keypoints > model.keypoint_count() ? s.settings.model_keypoints : 0;
  s.own_descriptors = workspace.take<Descriptor>(own);
  s.own_frames = workspace.take<LocalFrame>(own);
  s.model_grid.lay_out(workspace, own > 0 ? m : 0);
  s.key_leans = workspace.take<float>(keys);
  s.matcher.lay_out(workspace, s.settings.model_keypoints);
  for (std::uint32_t worker = 0; worker < s.settings.workers; ++worker) {
    s.describers[worker].lay_out(workspace);
    if (worker > 0) s.helpers[worker].lay_out_helper(workspace, s.settings.model_keypoints);
  }
  s.grouping.lay_out(workspace, keys);
  s.warp.lay_out(workspace, m, n);
  s.islands.lay_out(workspace, m);
  s.readings.lay_out(workspace, m);
  s.model_index.lay_out(workspace, m);
  s.prefix = workspace.take<std::uint16_t>(m);
  s.part = workspace.take<std::uint16_t>(m);
  s.open = workspace.take<std::uint8_t>(m);
  s.off = workspace.take<float>(m);
  s.gap_nearest = workspace.take<std::uint32_t>(m);
  s.proposal = workspace.take<std::uint32_t>(m);
  s.along = workspace.take<float>(m);
  s.anchor = workspace.take<std::uint16_t>(m);
  s.claimed = workspace.take<std::uint32_t>(n);
  s.picture = workspace.take<std::uint16_t>(n);
  s.picture_points = workspace.take<Point3f>(n);
  s.depth_block = workspace.take<std::byte>(depth_search_bytes(model, n));
  for (std::uint32_t k = 0; k < s.settings.max_instances; ++k) {
    InstanceBuffers& b = s.buffers[k];
    const std::span<std::byte> regions =
        workspace.take<std::byte>(limits::kMaxRegions * sizeof(RegionResult));
    if (!regions.empty()) {
      auto* first = static_cast<RegionResult*>(static_cast<void*>(regions.data()));
      for (int r = 0; r < limits::kMaxRegions; ++r) new (first + r) RegionResult();
      b.regions = {first, static_cast<std::size_t>(limits::kMaxRegions)};
    }
    b.positions = workspace.take<Point3f>(m);
    b.labels = workspace.take<std::int8_t>(m);
    b.matches = workspace.take<std::int32_t>(m);
    b.residuals = workspace.take<float>(m);
  }
}

}  // namespace pliant
