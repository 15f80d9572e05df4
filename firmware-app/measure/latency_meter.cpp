#include "firmware-app/measure/latency_meter.hpp"

#include "firmware-app/measure/clock.hpp"

namespace pliant {

void LatencyMeter::arrived(std::int64_t utime, std::int64_t arrival_ns) noexcept {
  const std::lock_guard lock(mutex_);
  marks_[next_] = {utime, arrival_ns};
  next_ = (next_ + 1) % marks_.size();
}

void LatencyMeter::sent(std::int64_t utime) noexcept {
  const std::int64_t now = monotonic_ns();
  const std::lock_guard lock(mutex_);
  for (Mark& mark : marks_)
    if (mark.utime == utime && mark.arrival_ns != 0) {
      whole_.add(now - mark.arrival_ns);
      recent_.add(now - mark.arrival_ns);
      mark.arrival_ns = 0;
      return;
    }
}

Histogram LatencyMeter::whole() const noexcept {
  const std::lock_guard lock(mutex_);
  return whole_;
}

std::array<std::int64_t, 3> LatencyMeter::take_recent() noexcept {
  const std::lock_guard lock(mutex_);
  const std::array<std::int64_t, 3> figures = {recent_.median(), recent_.p99(), recent_.max()};
  recent_.clear();
  return figures;
}

}  // namespace pliant
