#include "core/track/narrowing.hpp"

#include <algorithm>

#include "core/track/steady.hpp"

namespace pliant {

namespace {

/// Half of the noise that is left in a pose: what a round moves by less was where it was expected. A share of
/// σ, as the next.
constexpr double kExpected = kNoiseOfPose / 2;
/// Each round moves a region by about half of what the one before did: what moves by less than a tenth of σ
/// would move, in all further rounds, by no more than that.
constexpr double kNothingMore = 0.1;

}  // namespace

Narrowing::Narrowing(const SearchWidths& widths, double sigma, const RegionSet& regions) noexcept
    : widths_(widths), sigma_(sigma) {
  for (std::size_t k = 0; k < regions.size(); ++k) width_[k] = regions[k].alive ? 0 : kAtRest;
}

bool Narrowing::at_rest() const noexcept {
  return std::all_of(width_.begin(), width_.end(), [](std::size_t width) { return width == kAtRest; });
}

SearchReaches Narrowing::reaches() const noexcept {
  SearchReaches reaches;
  for (std::size_t k = 0; k < reaches.size(); ++k)
    if (width_[k] != kAtRest) reaches[k] = widths_[width_[k]].reach;
  return reaches;
}

std::array<std::int32_t, limits::kMaxRegions> Narrowing::widest() const noexcept {
  std::array<std::int32_t, limits::kMaxRegions> widest{};
  for (std::size_t k = 0; k < widest.size(); ++k)
    if (width_[k] != kAtRest) widest[k] = widths_[width_[k]].widest;
  return widest;
}

void Narrowing::go_on(const AlignSteps& steps) noexcept {
  for (std::size_t k = 0; k < width_.size(); ++k) {
    const bool was_moved = steps[k] >= 0;
    if (width_[k] < kLast)
      width_[k] = was_moved && steps[k] < kExpected * sigma_ ? kLast : width_[k] + 1;
    else if (!(steps[k] >= kNothingMore * sigma_))
      width_[k] = kAtRest;
  }
}

}  // namespace pliant
