// Where regions meet.
#pragma once

#include "core/track/patches.hpp"

namespace pliant {

/// The patches that hold points of more than one region, or are next to one that holds points of another:
/// elsewhere no point can go over to another region. `home`: region of every model point.
[[nodiscard]] PatchSet border_patches(const PatchTables& patches, std::span<const std::int8_t> home) noexcept;

}  // namespace pliant
