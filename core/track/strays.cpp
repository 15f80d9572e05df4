#include "core/track/strays.hpp"

namespace pliant {

void recall_strays(const PatchTables& patches, const PatchWarp& warp, PointState& points) noexcept {
  std::array<std::uint32_t, kMaxPatches> around{};  // homes of a patch and its neighbours, one bit each
  for (std::size_t p = 0; p < patches.count; ++p) {
    around[p] = std::uint32_t{1} << warp.home[p];
    patches.neighbours[p].for_each([&](std::size_t q) { around[p] |= std::uint32_t{1} << warp.home[q]; });
  }
  for (std::size_t i = 0; i < points.home.size(); ++i) {
    const std::size_t p = patches.patch_of[i];
    if ((around[p] >> points.home[i] & 1U) != 0) continue;
    points.home[i] = warp.home[p];
    points.rival[i] = -1;
    points.switching[i] = 0;
    points.evidence[i] = 0;
  }
}

}  // namespace pliant
