// What hangs on what: every region but the base on the one that it moved off.
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

/// Does region `k` hang on region `on`, directly or by others?
[[nodiscard]] bool hangs_on(const RegionSet& regions, std::int8_t k, std::int8_t on) noexcept;

/// Hangs region `k` on `parent`, where it is; -1: on nothing. What nobody sees is where what it hangs on
/// takes it.
void hang(RegionSet& regions, std::size_t k, std::int8_t parent) noexcept;

/// Region `to` takes over how `from` moves; what hangs on it stays where it is.
void take_motion(RegionSet& regions, std::size_t to, const TrackedRegion& from) noexcept;

}  // namespace pliant
