#include "firmware-app/pipeline/capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "firmware-app/measure/clock.hpp"

namespace pliant {

namespace {

constexpr int kPatienceMs = 100;  // how long a stop may go unseen

}  // namespace

void Capture::run() {
  SourceItem item;
  const Intrinsics& camera = source_.intrinsics();
  while (!stopped() && (settings_.frame_limit < 0 || taken() < settings_.frame_limit)) {
    source_.next(kPatienceMs, item);
    if (item.event != SourceEvent::timeout || source_.live()) beats_.fetch_add(1, std::memory_order_relaxed);
    if (item.event == SourceEvent::end || item.event == SourceEvent::lost) break;
    if (item.event == SourceEvent::timeout) {
      if (!item.fault.empty()) note_fault(item.fault);
      continue;
    }
    taken_.fetch_add(1, std::memory_order_relaxed);
    device_.store(DeviceState::streaming, std::memory_order_relaxed);
    const DepthFrame& frame = item.frame;
    if (item.event == SourceEvent::frame && (frame.width != camera.width || frame.height != camera.height)) {
      item.event = SourceEvent::bad_frame;
      item.fault = fmt::format("frame {} is {}x{}, the camera {}x{}", frame.number, frame.width, frame.height,
                               camera.width, camera.height);
    }
    if (item.event == SourceEvent::bad_frame) {
      note_fault(item.fault);
      bad_frames_.fetch_add(1, std::memory_order_relaxed);
      continue;
    }
    if (settings_.pace_by_stamps) wait_until_due(frame.utime);
    if (stopped() || !ring_.push(frame, monotonic_ns())) break;
  }
  if (item.event == SourceEvent::lost) note_fault(item.fault);
  device_.store(item.event == SourceEvent::lost ? DeviceState::lost : DeviceState::ended,
                std::memory_order_relaxed);
  ring_.close();
}

DeviceState Capture::device() const noexcept {
  const DeviceState own = device_.load(std::memory_order_relaxed);
  const bool over = own == DeviceState::ended || own == DeviceState::lost;
  return over || monitor() == nullptr ? own : monitor()->state();
}

void Capture::wait_until_due(std::int64_t utime) {
  if (!first_seen_) {
    first_seen_ = true;
    first_utime_ = utime;
    first_ns_ = monotonic_ns();
  }
  // A stamp that jumps by more than ten seconds is a fault of the recording, not a pause to be kept.
  std::int64_t due = first_ns_ + (utime - first_utime_) * 1000;
  const std::int64_t now = monotonic_ns();
  if (due > now + 10'000'000'000 || due < now - 10'000'000'000) {
    first_utime_ = utime;
    first_ns_ = due = now;
  }
  while (!stopped() && monotonic_ns() < due) {
    sleep_until_ns(std::min(due, monotonic_ns() + std::int64_t{kPatienceMs} * 1'000'000));
    beats_.fetch_add(1, std::memory_order_relaxed);
  }
}

void Capture::note_fault(const std::string& fault) {
  const std::lock_guard lock(mutex_);
  const std::size_t length = std::min(fault.size(), fault_.size() - 1);
  std::memcpy(fault_.data(), fault.data(), length);
  fault_[length] = '\0';
}

void Capture::copy_fault(std::span<char> text) const noexcept {
  const std::lock_guard lock(mutex_);
  const std::size_t length = std::min(std::strlen(fault_.data()), text.size() - 1);
  std::memcpy(text.data(), fault_.data(), length);
  text[length] = '\0';
}

std::string Capture::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_.data();
}

}  // namespace pliant
