#include "core/track/borders.hpp"

namespace pliant {

PatchSet border_patches(const PatchTables& patches, std::span<const std::int8_t> home) noexcept {
  std::array<std::uint8_t, kMaxPatches> regions{};  // one bit each
  static_assert(limits::kMaxRegions <= 8);
  for (std::size_t i = 0; i < home.size(); ++i)
    regions[patches.patch_of[i]] |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(home[i]));
  const auto several = [](unsigned bits) { return (bits & (bits - 1)) != 0; };
  PatchSet out;
  for (std::size_t p = 0; p < patches.count; ++p)
    if (several(regions[p])) out.add(p);
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    if (!several(regions[border.a] | regions[border.b])) continue;
    out.add(border.a);
    out.add(border.b);
  }
  return out;
}

}  // namespace pliant
