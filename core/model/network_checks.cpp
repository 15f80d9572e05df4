#include "core/model/network_checks.hpp"

#include <array>
#include <cstddef>

#include "core/model/model_view.hpp"

namespace pliant {

namespace {

/// False also for what is not a number.
bool near_object(const ModelView& view, const RestPlace& place) {
  const double limit = 2 * view.radius();
  return (to_vector(place) - view.centre()).squaredNorm() <= limit * limit;
}

bool length_is_sane(const ModelView& view, double length) {
  return length > 0 && length <= 4 * view.radius();
}

bool blend_is_sane(const PointBlend& blend, std::size_t patches) {
  int sum = 0;
  bool ended = false;
  for (std::size_t j = 0; j < blend.patch.size(); ++j) {
    if (blend.patch[j] >= patches || (ended && blend.weight[j] != 0)) return false;
    ended = ended || blend.weight[j] == 0;
    sum += blend.weight[j];
  }
  return sum == 1 << PointBlend::kShift;
}

/// `before`: the pair of the link before it.
template <typename Link>
bool pair_is_sane(const Link& link, std::size_t patches, int& before) {
  const int pair = 256 * link.a + link.b;
  const bool sane = link.a < link.b && link.b < patches && pair > before;
  before = pair;
  return sane;
}

bool patches_are_sane(const ModelView& view) {
  const std::size_t patches = view.patches().size();
  std::array<std::uint32_t, limits::kMaxPatches> points{};
  for (const std::uint8_t p : view.patch_of()) {
    if (p >= patches) return false;
    ++points[p];
  }
  for (std::size_t p = 0; p < patches; ++p) {
    const ModelPatch& patch = view.patches()[p];
    if (patch.points == 0 || patch.points != points[p] || !near_object(view, patch.centre)) return false;
  }
  for (const PointBlend& blend : view.blends())
    if (!blend_is_sane(blend, patches)) return false;
  return true;
}

}  // namespace

bool network_is_sane(const ModelView& view) noexcept {
  if (!patches_are_sane(view)) return false;
  const std::size_t patches = view.patches().size();
  int before = -1;
  for (const SurfaceLink& link : view.surface_links())
    if (!pair_is_sane(link, patches, before) || link.edges == 0 ||
        link.edges > view.size() * limits::kNeighbours || !near_object(view, link.centre) ||
        !length_is_sane(view, link.length))
      return false;
  before = -1;
  for (const BodyLink& link : view.body_links())
    if (!pair_is_sane(link, patches, before) || link.looks == 0 || link.looks > view.size() ||
        !near_object(view, link.middle) || !length_is_sane(view, link.length))
      return false;
  return true;
}

}  // namespace pliant
