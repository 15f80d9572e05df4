// Links across the body of a model.
#pragma once

#include <vector>

#include "drivers/model_files/spring_network.hpp"

namespace pliant {

/// Looks from evenly spread points along their inward normals to where the body ends, and ties the patches
/// between which it found the most of it: ascending by (a, b), at most limits::kMaxBodyLinks. `patch_of` as
/// in SpringNetwork, of `patches` patches.
[[nodiscard]] std::vector<BodyLink> body_links(const NetworkInput& input,
                                               std::span<const std::uint8_t> patch_of, std::size_t patches);

}  // namespace pliant
