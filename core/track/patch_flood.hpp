// Sets of patches that grow over the surface.
#pragma once

#include <array>

#include "core/track/patches.hpp"

namespace pliant {

/// The set and all that is reached from it over neighbouring patches, nearest first: `enters(from, to)` tells
/// whether a patch is entered from its neighbour; it is asked until it says yes.
template <typename Enters>
[[nodiscard]] PatchSet flood(const PatchTables& patches, const PatchSet& set, Enters enters) noexcept {
  std::array<std::uint8_t, kMaxPatches> queue{};
  std::size_t head = 0, tail = 0;
  PatchSet reached = set;
  for (std::size_t p = 0; p < patches.count; ++p)
    if (set.has(p)) queue[tail++] = static_cast<std::uint8_t>(p);
  while (head < tail) {
    const std::size_t p = queue[head++];
    for (std::size_t q = 0; q < patches.count; ++q) {
      if (!patches.neighbours[p].has(q) || reached.has(q) || !enters(p, q)) continue;
      reached.add(q);
      queue[tail++] = static_cast<std::uint8_t>(q);
    }
  }
  return reached;
}

}  // namespace pliant
