#include "core/track/borders.hpp"

namespace pliant {

RegionBorders region_borders(const PatchTables& patches, std::span<const std::int8_t> home) noexcept {
  std::array<std::uint8_t, kMaxPatches> own{};
  for (std::size_t i = 0; i < home.size(); ++i)
    own[patches.patch_of[i]] |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(home[i]));
  RegionBorders borders{own};
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    borders.near[border.a] |= own[border.b];
    borders.near[border.b] |= own[border.a];
  }
  return borders;
}

}  // namespace pliant
