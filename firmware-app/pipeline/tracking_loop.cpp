#include "firmware-app/pipeline/tracking_loop.hpp"

#include <array>
#include <optional>

#include "drivers/common/clock.hpp"
#include "firmware-app/measure/clock.hpp"

namespace pliant {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr int kIdleMs = 20;  // how late a change of the device's state may be told

std::int32_t microseconds(std::int64_t nanoseconds) {
  return static_cast<std::int32_t>((nanoseconds + 500) / 1000);
}

}  // namespace

TrackingLoop::TrackingLoop(const Parts& parts, const Settings& settings)
    : parts_(parts), settings_(settings), work_(settings.budget_ns) {}

void TrackingLoop::run(RunFigures& figures) {
  touch_stack();
  parts_.tracker.observe(figures.profile.observer());
  std::int64_t end_ns = 0;
  std::optional<PathWatch> watch(std::in_place, parts_.cost);
  last_status_ns_ = monotonic_ns();
  rate_ = FrameRate(last_status_ns_);
  while (!parts_.ring.ended()) {
    const CapturedFrame* captured = parts_.ring.pop(kIdleMs);
    if (captured == nullptr) {
      publish_status_if_due(figures, false);
      continue;
    }
    if (first_arrival_ns_ == 0) first_arrival_ns_ = captured->arrival_ns;
    parts_.live.begun.fetch_add(1, std::memory_order_relaxed);
    take(*captured, figures);
    parts_.live.finished.fetch_add(1, std::memory_order_relaxed);
    end_ns = monotonic_ns();
    watch->update();
  }
  figures.seconds = static_cast<double>(end_ns - first_arrival_ns_) * 1e-9;
  figures.deadline_misses = work_.misses();
  figures.least_work_level = work_.least_level();
  watch.reset();
  parts_.tracker.observe({});
  if (settings_.hash) figures.output_sha256 = hash_.hex();
}

void TrackingLoop::publish_end(const RunFigures& figures) {
  if (parts_.publisher != nullptr) publish_status(figures);
}

void TrackingLoop::publish_status_if_due(const RunFigures& figures, bool state_changed) {
  if (parts_.publisher == nullptr) return;
  const DeviceMonitor* monitor = parts_.capture.monitor();
  const bool device_changed =
      monitor != nullptr && (parts_.capture.device() != told_device_ || monitor->fault() != told_fault_ ||
                             monitor->blind() != told_blind_);
  if (state_changed || device_changed || monotonic_ns() - last_status_ns_ >= kSecond) publish_status(figures);
}

void TrackingLoop::take(const CapturedFrame& captured, RunFigures& figures) {
  figures.profile.begin_frame();
  const TrackResult& result = parts_.tracker.process(captured.frame);
  const bool tracked = result.frame_used && result.state == TrackState::tracking;
  if (!result.frame_used) {
    ++figures.bad_frames;
    return;
  }
  figures.profile.end_frame(tracked);
  recent_.add_last_of(figures.profile, tracked);

  last_frame_ = captured.frame.number;
  const bool state_changed = figures.frames() == 0 || result.state != figures.last_state;
  figures.last_state = result.state;
  if (tracked) {
    figures.last_pose = result.pose;
    figures.last_strain_energy = result.strain_energy;
  }
  if (tracked && figures.first_tracked < 0) figures.first_tracked = captured.frame.number;
  ++(tracked ? figures.tracked : result.state == TrackState::lost ? figures.lost : figures.searching);

  hand_over(captured, result);
  if (parts_.witness.seen != nullptr) parts_.witness.seen(parts_.witness.context, captured.frame, result);
  parts_.tracker.set_work_level(work_.next_level(figures.profile.last_total()));
  publish_status_if_due(figures, state_changed);

  parts_.live.frame.store(captured.frame.number, std::memory_order_relaxed);
  parts_.live.frames.store(figures.frames(), std::memory_order_relaxed);
  parts_.live.tracked.store(figures.tracked, std::memory_order_relaxed);
  parts_.live.state.store(result.state, std::memory_order_relaxed);
  parts_.live.last_total_ns.store(figures.profile.last_total(), std::memory_order_relaxed);
  parts_.live.confidence.store(trust() * result.confidence, std::memory_order_relaxed);
  parts_.live.deadline_misses.store(work_.misses(), std::memory_order_relaxed);
  parts_.live.work_level.store(work_.level(), std::memory_order_relaxed);
  parts_.live.regions.store(static_cast<int>(result.regions.size()), std::memory_order_relaxed);
}

void TrackingLoop::hand_over(const CapturedFrame& captured, const TrackResult& result) {
  const std::span<const MessageBody> bodies = parts_.messages.encode(result, trust());
  if (settings_.hash) hash_.add(bodies);
  parts_.latency.arrived(result.utime, captured.arrival_ns);
  if (parts_.publisher != nullptr) {
    // Waits for the frame before, which is normally long out; a second is more than any network needs.
    if (settings_.wait_for_publisher) static_cast<void>(parts_.publisher->flush(1000));
    parts_.publisher->publish(bodies, result.utime);
    if (settings_.publish_depth) parts_.publisher->publish_depth(captured.frame, settings_.camera);
  } else {
    parts_.latency.sent(result.utime);
  }
  if (parts_.files != nullptr) parts_.files->submit(result);
}

float TrackingLoop::trust() const noexcept {
  const DeviceMonitor* monitor = parts_.capture.monitor();
  return monitor == nullptr ? 1.0F : monitor->rate_share();
}

void TrackingLoop::fill_device(StatusContent& status) const {
  status.device = parts_.capture.device();
  const DeviceMonitor* monitor = parts_.capture.monitor();
  if (monitor == nullptr) return;
  // The state is that of the last frame; where none comes it must not be told as if it were the present one.
  if (monitor->blind() && status.state == TrackState::tracking) status.state = TrackState::lost;
  status.stream_fault = monitor->fault();
  status.zero_frames = monitor->frames(StreamFault::zero);
  status.stuck_frames = monitor->frames(StreamFault::stuck);
  status.noise_frames = monitor->frames(StreamFault::noise);
  status.wrong_size_frames = monitor->frames(StreamFault::wrong_size);
  status.delayed_frames = monitor->frames(StreamFault::delayed);
  status.slow_frames = monitor->frames(StreamFault::slow);
  status.broken_frames = monitor->frames(StreamFault::broken);
  status.stalls = monitor->stalls();
  status.reopenings = monitor->reopenings();
}

void TrackingLoop::publish_status(const RunFigures& figures) {
  const std::int64_t now = monotonic_ns();
  std::array<StageTimes, kStageCount + 1> stages{};
  for (int i = 0; i <= kStageCount; ++i) {
    const Histogram& times = recent_.stage(i);
    stages[static_cast<std::size_t>(i)] = {kStageNames[static_cast<std::size_t>(i)],
                                           microseconds(times.median()), microseconds(times.p99()),
                                           microseconds(times.max())};
  }
  const std::array<std::int64_t, 3> latency = parts_.latency.take_recent();
  const SendCounters sent = parts_.publisher->counters();
  std::array<char, 256> fault{};
  parts_.capture.copy_fault(fault);

  StatusContent status;
  status.utime = clock_us(CLOCK_REALTIME);
  status.version = settings_.version;
  status.source = settings_.source;
  status.model_id = settings_.model_id;
  status.frame = last_frame_;
  status.state = figures.last_state;
  fill_device(status);
  status.rate = static_cast<float>(rate_.update(now, figures.frames()));
  if (status.state == TrackState::tracking) status.strain_energy = figures.last_strain_energy;
  status.latency_median_us = microseconds(latency[0]);
  status.latency_p99_us = microseconds(latency[1]);
  status.latency_max_us = microseconds(latency[2]);
  status.stages = stages;
  status.tracked = figures.tracked;
  status.searching = figures.searching;
  status.lost = figures.lost;
  status.dropped = static_cast<std::int64_t>(parts_.ring.dropped());
  status.bad_frames = figures.bad_frames + parts_.capture.bad_frames();
  status.deadline_misses = work_.misses();
  status.unsent = sent.unsent;
  status.send_failures = sent.failures;
  status.workspace_bytes = static_cast<std::int64_t>(settings_.workspace_bytes);
  status.rss_bytes = static_cast<std::int64_t>(resident_bytes());
  status.heap_calls = static_cast<std::int64_t>(parts_.cost.heap_calls.load(std::memory_order_relaxed));
  status.page_faults = static_cast<std::int64_t>(parts_.cost.page_faults.load(std::memory_order_relaxed));
  status.last_error = fault.data();
  parts_.publisher->publish_status(status);

  told_device_ = status.device;
  told_fault_ = status.stream_fault;
  told_blind_ = parts_.capture.monitor() == nullptr || parts_.capture.monitor()->blind();
  recent_.clear();
  last_status_ns_ = now;
}

}  // namespace pliant
