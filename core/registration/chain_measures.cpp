#include "core/registration/chain_measures.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/fast_transform.hpp"

namespace pliant {

namespace {

/// Distance between model keypoints: so far a right match may be off.
double key_spacing(const RegistrationState& s) noexcept {
  return s.model.spacing() * std::sqrt(static_cast<double>(s.model.size()) /
                                       static_cast<double>(std::max<std::size_t>(1, s.model_key_count)));
}

}  // namespace

double match_tolerance(const RegistrationState& s) noexcept {
  return 1.5 * std::max(key_spacing(s), s.spacing);
}

double working_reach(const RegistrationState& s) noexcept {
  return 1.5 * std::max(s.support / 7, s.spacing);
}

CloudTarget working_target(const RegistrationState& s) noexcept {
  return {&s.working_grid, s.working.first(s.working_count), s.working_normals.first(s.working_count),
          s.working_taken.first(s.working_count)};
}

CloudTarget base_target(const RegistrationState& s) noexcept {
  return {&s.base_grid, s.base.first(s.base_count), {}, s.base_taken.first(s.base_count)};
}

std::size_t align_to_base(const RegistrationState& s, std::span<const std::uint16_t> which,
                          const AlignSettings& settings, RigidTransform& pose) noexcept {
  // Where nothing is near, all points within the gate are looked at: those of a surface across it.
  const double gate = 0.5 * (settings.first_gate + settings.last_gate) + settings.reach;
  const double across = 2 * gate / s.base_spacing;
  const std::uint64_t each = work::kNearest + static_cast<std::uint64_t>(work::kCandidate * across * across);
  s.work += which.size() * static_cast<std::size_t>(settings.iterations) * each;
  return align_to_cloud(s.model, which, base_target(s), settings, pose);
}

void refine(const RegistrationState& s, std::span<const std::uint16_t> which, double noise,
            RigidTransform& pose) noexcept {
  if (!s.settings.refinement) return;
  const double last = std::max(1.5 * s.spacing, 4 * noise);
  const AlignSettings fine = {std::max(match_tolerance(s), last), last, 1.5 * s.spacing, 10};
  RigidTransform refined = pose;
  if (align_to_base(s, which, fine, refined) > 0) pose = refined;
}

void measure(RegistrationState& s, const RigidTransform& pose, double noise, bool only_free) noexcept {
  const std::span<const std::uint8_t> taken =
      only_free ? std::span<const std::uint8_t>(s.base_taken.first(s.base_count))
                : std::span<const std::uint8_t>();
  s.work += s.base_count * work::kNearest;
  s.readings.measure(s.model, s.model_index, s.base.first(s.base_count), taken, pose, 1.5 * s.spacing,
                     std::max(2.5 * s.spacing, 4 * noise));
}

double scene_noise(RegistrationState& s) noexcept {
  std::size_t count = 0;
  const std::size_t most = std::min<std::size_t>(800, s.model.size());
  for (std::size_t i = 0; i < most; ++i) {
    const SurfaceGap gap = s.readings.gap(s.model, i);
    if (gap.count >= 4) s.scratch[count++] = gap.spread;
  }
  if (count < 20) return 0;
  std::nth_element(s.scratch.begin(), s.scratch.begin() + static_cast<std::ptrdiff_t>(count / 2),
                   s.scratch.begin() + static_cast<std::ptrdiff_t>(count));
  return static_cast<double>(s.scratch[count / 2]);
}

float off_surface(const RegistrationState& s, std::size_t i, double noise) noexcept {
  const SurfaceGap gap = s.readings.gap(s.model, i);
  if (gap.count == 0) return -1;
  const double left = 4 * noise / std::sqrt(static_cast<double>(gap.count));
  return static_cast<float>(static_cast<double>(std::fabs(gap.along)) / std::max(s.model.spacing(), left));
}

void take_points(RegistrationState& s, const InstanceBuffers& buffers, std::int8_t label,
                 const RigidTransform& pose, double noise) noexcept {
  const FastTransform back(pose.inverse());
  const auto across = static_cast<float>(1.5 * s.spacing);
  const auto deep = static_cast<float>(std::max(s.model.spacing(), 3 * noise));
  const float reach = std::sqrt(across * across + deep * deep);
  for (std::size_t j = 0; j < s.base_count; ++j) {
    if (s.base_taken[j] != 0) continue;
    const Point3f p = back.point(s.base[j]);
    float square = 0;
    const std::uint32_t i = s.model_index.nearest(p, reach, square);
    if (i == PointGrid::kNone || buffers.labels[i] != label) continue;
    const Point3f& m = s.model.positions()[i];
    const Normal16& n = s.model.normals()[i];
    const float along = (static_cast<float>(n.x) * (p.x - m.x) + static_cast<float>(n.y) * (p.y - m.y) +
                         static_cast<float>(n.z) * (p.z - m.z)) *
                        (1.0F / 16384);
    if (std::fabs(along) <= deep) s.base_taken[j] = 1;
  }
}

}  // namespace pliant
