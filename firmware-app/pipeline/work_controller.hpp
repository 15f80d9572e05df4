// Turns a time budget into the tracker's work level.
#pragma once

#include <algorithm>
#include <cstdint>

namespace pliant {

/// A frame over budget lowers the level in proportion; frames well within it raise it slowly, so that the
/// level settles below the budget instead of swinging around it.
class WorkController {
 public:
  /// `budget_ns` <= 0: everything is always done.
  explicit WorkController(std::int64_t budget_ns) noexcept : budget_ns_(budget_ns) {}

  /// Told how long a frame took; the level for the next one, 0 to 1.
  double next_level(std::int64_t took_ns) noexcept {
    if (budget_ns_ <= 0) return 1;
    const double share = static_cast<double>(took_ns) / static_cast<double>(budget_ns_);
    if (share > 1) {
      ++misses_;
      level_ = std::max(0.0, level_ * std::max(0.5, 0.9 / share));
      least_ = std::min(least_, level_);
    } else if (share < 0.8) {
      level_ = std::min(1.0, level_ + 0.02);
    }
    return level_;
  }
  [[nodiscard]] std::int64_t misses() const noexcept { return misses_; }
  [[nodiscard]] double level() const noexcept { return level_; }
  [[nodiscard]] double least_level() const noexcept { return least_; }

 private:
  std::int64_t budget_ns_;
  std::int64_t misses_ = 0;
  double level_ = 1, least_ = 1;
};

}  // namespace pliant
