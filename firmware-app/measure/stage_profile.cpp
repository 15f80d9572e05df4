#include "firmware-app/measure/stage_profile.hpp"

#include <algorithm>

#include "firmware-app/measure/clock.hpp"

namespace pliant {

StageObserver StageProfile::observer() noexcept {
  return {&StageProfile::stage_done, this};
}

void StageProfile::begin_frame() noexcept {
  spent_.fill(-1);
  begin_ = stamp_ = monotonic_ns();
}

void StageProfile::stage_done(void* context, Stage stage) noexcept {
  auto* self = static_cast<StageProfile*>(context);
  const std::int64_t now = monotonic_ns();
  std::int64_t& spent = self->spent_[static_cast<std::size_t>(stage)];
  spent = std::max<std::int64_t>(spent, 0) + now - self->stamp_;
  self->stamp_ = now;
}

void StageProfile::end_frame(bool tracked) noexcept {
  last_total_ = monotonic_ns() - begin_;
  add_last_of(*this, tracked);
}

void StageProfile::add_last_of(const StageProfile& other, bool tracked) noexcept {
  for (std::size_t i = 0; i < kStageCount; ++i)
    if (other.spent_[i] >= 0) histograms_[i].add(other.spent_[i]);
  if (tracked) histograms_[kStageCount].add(other.last_total_);
}

}  // namespace pliant
