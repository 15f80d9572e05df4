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
  set.for_each([&](std::size_t p) { queue[tail++] = static_cast<std::uint8_t>(p); });
  while (head < tail) {
    const std::size_t p = queue[head++];
    patches.neighbours[p].for_each([&](std::size_t q) {
      if (reached.has(q) || !enters(p, q)) return;
      reached.add(q);
      queue[tail++] = static_cast<std::uint8_t>(q);
    });
  }
  return reached;
}

}  // namespace pliant
