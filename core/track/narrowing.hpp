// How far off every region is looked for, round by round: the narrower the nearer it is.
#pragma once

#include "core/track/align.hpp"
#include "core/track/associate.hpp"

namespace pliant {

/// One round's look for a region.
struct SearchWidth {
  SearchReach reach;
  std::int32_t widest = 0;  ///< as AlignSettings has it
};

/// From the first round's to the last one's.
using SearchWidths = std::array<SearchWidth, 4>;

/// Most rounds in a frame: a region that still moves at the last width is looked for there in what is left of
/// them.
inline constexpr int kMostRounds = static_cast<int>(SearchWidths().size()) + 1;

/// Which width every region has come to. Each round takes a region to the next; one that a round barely moved
/// is where it was expected, and the last alone has more to say. What that barely moves is at rest: it is
/// looked for no more.
class Narrowing {
 public:
  /// `widths` outlive this. `sigma`: of a reading at the object, metres. The regions that are alive.
  Narrowing(const SearchWidths& widths, double sigma, const RegionSet& regions) noexcept;

  [[nodiscard]] bool at_rest() const noexcept;
  /// Of the next round; no points of what is at rest.
  [[nodiscard]] SearchReaches reaches() const noexcept;
  [[nodiscard]] std::array<std::int32_t, limits::kMaxRegions> widest() const noexcept;
  /// After a round that moved the regions by `steps`.
  void go_on(const AlignSteps& steps) noexcept;

 private:
  static constexpr std::size_t kAtRest = SearchWidths().size(), kLast = kAtRest - 1;

  const SearchWidths& widths_;
  double sigma_;
  std::array<std::size_t, limits::kMaxRegions> width_;  // index in widths_, or kAtRest
};

}  // namespace pliant
