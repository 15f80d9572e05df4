#include "core/track/patches.hpp"

#include <algorithm>

namespace pliant {

void PatchTables::lay_out(Workspace& workspace, std::size_t points) noexcept {
  patch_of = workspace.take<std::uint8_t>(points);
}

void PatchTables::start(const ModelTables& model, std::span<std::uint16_t> queue) noexcept {
  constexpr std::uint8_t kNone = 0xFF;
  static_assert(kMaxPatches < kNone);
  count = std::min(kMaxPatches, std::max<std::size_t>(1, model.size / 16));
  std::fill(patch_of.begin(), patch_of.end(), kNone);
  std::size_t head = 0, tail = 0;
  for (std::size_t p = 0; p < count; ++p) {
    patch_of[p] = static_cast<std::uint8_t>(p);
    queue[tail++] = static_cast<std::uint16_t>(p);
  }
  while (head < tail) {
    const std::size_t i = queue[head++];
    for (const std::uint16_t n : model.model->neighbours(i)) {
      if (n >= model.size || patch_of[n] != kNone) continue;
      patch_of[n] = patch_of[i];
      queue[tail++] = n;
    }
  }
  for (std::size_t i = 0; i < model.size; ++i)
    if (patch_of[i] == kNone) patch_of[i] = 0;  // not connected to any seed
  neighbours = {};
  for (std::size_t i = 0; i < model.size; ++i)
    for (const std::uint16_t n : model.model->neighbours(i)) {
      if (n >= model.size || patch_of[n] == patch_of[i]) continue;
      neighbours[patch_of[i]].add(patch_of[n]);
      neighbours[patch_of[n]].add(patch_of[i]);
    }
}

}  // namespace pliant
