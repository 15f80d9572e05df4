#include "firmware-app/pipeline/live_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "drivers/common/clock.hpp"
#include "firmware-app/measure/clock.hpp"

namespace pliant {

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9);
}

std::string fault_text(StreamFault fault, const DepthFrame& frame, const Intrinsics& camera) {
  switch (fault) {
    case StreamFault::zero:
      return fmt::format("frame {} has no reading at all; is the camera covered?", frame.number);
    case StreamFault::stuck:
      return fmt::format("frame {} is the one before again", frame.number);
    case StreamFault::noise:
      return fmt::format("frame {} is noise", frame.number);
    case StreamFault::wrong_size:
      return fmt::format("frame {} is {}x{}, the camera {}x{}", frame.number, frame.width, frame.height,
                         camera.width, camera.height);
    case StreamFault::delayed:
      return fmt::format("frame {} came late", frame.number);
    case StreamFault::none:
    case StreamFault::slow:
    case StreamFault::broken:
      break;
  }
  return {};
}

bool same_mode(const Intrinsics& a, const Intrinsics& b) {
  const auto values = [](const Intrinsics& c) { return std::array{c.fx, c.fy, c.cx, c.cy, c.depth_scale}; };
  return a.width == b.width && a.height == b.height && values(a) == values(b);
}

}  // namespace

Result<std::unique_ptr<LiveSource>> LiveSource::open(LiveSettings settings) {
  Result<std::unique_ptr<DepthSource>> device = settings.open();
  if (!device) return device.error();
  return std::unique_ptr<LiveSource>(new LiveSource(std::move(settings), std::move(*device)));
}

LiveSource::LiveSource(LiveSettings settings, std::unique_ptr<DepthSource> device)
    : settings_(std::move(settings)),
      device_(std::move(device)),
      camera_(device_->intrinsics()),
      sensor_(device_->sensor()),
      rate_(device_->rate()),
      judge_(camera_, sensor_, rate_),
      place_(device_->place()) {
  opened_ns_ = useful_ns_ = alive_ns_ = monotonic_ns();
  monitor_.set_state(DeviceState::opening);
}

void LiveSource::close() {
  closed_ = true;
  device_.reset();
  monitor_.set_state(DeviceState::ended);
}

std::int64_t LiveSource::loss_ns() const noexcept {
  if (last_frame_ns_ == 0) return nanoseconds(settings_.first_frame);
  return std::max(nanoseconds(settings_.most_stall), 15 * judge_.frame_time_ns());
}

void LiveSource::next(int timeout_ms, SourceItem& item) {
  item.frame = {};
  item.fault.clear();
  item.event = SourceEvent::end;
  if (closed_) return;
  if (!asked_) {
    // What lies between opening and the first question is not the device's fault.
    asked_ = true;
    opened_ns_ = useful_ns_ = alive_ns_ = looked_ns_ = monotonic_ns();
  }
  const std::int64_t until = monotonic_ns() + std::max(timeout_ms, 0) * kMillisecond;
  do {
    item.event = SourceEvent::timeout;
    leave_out_pause();
    if (monotonic_ns() - alive_ns_ > nanoseconds(settings_.patience)) {
      const std::string last = reason_.empty() ? "no usable frame" : reason_;
      device_.reset();
      monitor_.set_state(DeviceState::lost);
      item.event = SourceEvent::lost;
      item.fault = fmt::format("the device did not come back within {:g} s: {}", settings_.patience, last);
      return;
    }
    if (device_ != nullptr)
      receive(until, item);
    else
      try_to_open(until, item);
  } while (item.event == SourceEvent::timeout && item.fault.empty() && monotonic_ns() < until);
}

void LiveSource::leave_out_pause() {
  const std::int64_t now = monotonic_ns(), pause = now - std::exchange(looked_ns_, now);
  if (pause <= nanoseconds(settings_.most_pause)) return;
  alive_ns_ += pause;
  useful_ns_ += pause;
}

void LiveSource::receive(std::int64_t until_ns, SourceItem& item) {
  // No longer than to the moment at which silence means something.
  const std::int64_t since = last_frame_ns_ != 0 ? last_frame_ns_ : opened_ns_;
  const bool stall_to_come = last_frame_ns_ != 0 && monitor_.state() == DeviceState::streaming;
  const std::int64_t due = since + (stall_to_come ? stall_ns() : loss_ns());
  const std::int64_t wait = std::min(until_ns, due) - monotonic_ns();
  const auto wait_ms =
      static_cast<int>(std::clamp<std::int64_t>((wait + kMillisecond - 1) / kMillisecond, 0, 1000));
  device_->next(wait_ms, item);
  leave_out_pause();
  const std::int64_t now = monotonic_ns();
  switch (item.event) {
    case SourceEvent::frame:
    case SourceEvent::bad_frame:
      take(item, now);
      return;
    case SourceEvent::timeout:
      watch_silence(now, item);
      return;
    case SourceEvent::end:
      lose("the device ended its stream", item);
      return;
    case SourceEvent::lost:
      lose(std::move(item.fault), item);
      return;
  }
}

void LiveSource::take(SourceItem& item, std::int64_t now) {
  last_frame_ns_ = now;
  // Frames that the device says were left out keep their numbers.
  const std::int64_t step = device_number_ < 0 ? 0 : item.frame.number - device_number_ - 1;
  device_number_ = item.frame.number;
  number_ += step > 0 && step < 1000 ? step : 0;
  item.frame.number = number_++;
  monitor_.set_state(DeviceState::streaming);
  StreamFault fault = StreamFault::broken;
  if (item.event == SourceEvent::frame) {
    fault = judge_.judge(item.frame, now, clock_us(CLOCK_REALTIME));
  }
  monitor_.judged(fault);
  monitor_.set_rate_share(judge_.rate_share());
  if (fault == StreamFault::none || fault == StreamFault::slow ||
      (fault == StreamFault::delayed && settings_.late_is_welcome)) {
    sound_ns_ = useful_ns_ = alive_ns_ = now;
    monitor_.set_blind(false);
    pause_ns_ = kFirstPause;
    attempts_ = 0;
    reason_.clear();
    return;
  }
  if (now - sound_ns_ >= stall_ns()) monitor_.set_blind(true);
  item.event = SourceEvent::bad_frame;
  if (fault != StreamFault::broken) item.fault = fault_text(fault, item.frame, camera_);
  reason_ = item.fault;
  // A camera without readings may be covered or too near: opening it again would not help.
  if (fault == StreamFault::zero) useful_ns_ = alive_ns_ = now;
  if (now - useful_ns_ > nanoseconds(settings_.most_useless)) {
    SourceItem lost;
    lose(fmt::format("no usable frame for {:g} s: {}", settings_.most_useless, item.fault), lost);
    item.frame.depth = nullptr;  // it went with the device
    item.fault = lost.fault;
  }
}

void LiveSource::watch_silence(std::int64_t now, SourceItem& item) {
  const std::int64_t since = last_frame_ns_ != 0 ? last_frame_ns_ : opened_ns_;
  if (now - since >= loss_ns()) {
    lose(last_frame_ns_ != 0 ? "the device gives no more frames" : "the device is open but gives no frame",
         item);
  } else if (last_frame_ns_ != 0 && now - since >= stall_ns() && monitor_.state() == DeviceState::streaming) {
    monitor_.set_state(DeviceState::stalled);
    monitor_.set_blind(true);
    monitor_.stalled();
    item.fault = fmt::format("no frame for {} ms", (now - since) / kMillisecond);
  }
}

void LiveSource::lose(std::string reason, SourceItem& item) {
  device_.reset();
  last_frame_ns_ = 0;
  monitor_.set_state(DeviceState::lost);
  monitor_.set_blind(true);
  if (settings_.arrivals != nullptr) arrivals_seen_ = settings_.arrivals->events();
  next_try_ns_ = monotonic_ns() + pause_ns_;
  reason_ = std::move(reason);
  item.event = SourceEvent::timeout;
  item.fault = reason_;
}

void LiveSource::try_to_open(std::int64_t until_ns, SourceItem& item) {
  const std::int64_t wait = std::max<std::int64_t>(0, std::min(until_ns, next_try_ns_) - monotonic_ns());
  if (settings_.arrivals != nullptr) {
    if (settings_.arrivals->wait(arrivals_seen_, std::chrono::nanoseconds(wait))) {
      arrivals_seen_ = settings_.arrivals->events();
      pause_ns_ = kFirstPause;
      next_try_ns_ = 0;
    }
  } else {
    sleep_until_ns(monotonic_ns() + wait);
  }
  if (monotonic_ns() >= next_try_ns_) attempt(item);
  looked_ns_ = monotonic_ns();  // opening may take long, which is the device's
}

void LiveSource::attempt(SourceItem& item) {
  if (monitor_.state() == DeviceState::lost) monitor_.set_state(DeviceState::reopening);
  // A device that stays away counts no attempts: there is nothing to reset.
  if (attempts_ > 0 && attempts_ % kAttemptsBeforeReset == 0 && settings_.reset) settings_.reset(place_);
  Result<std::unique_ptr<DepthSource>> device = settings_.open();
  if (device && !same_mode((*device)->intrinsics(), camera_)) {
    const Intrinsics& other = (*device)->intrinsics();
    const std::string what =
        fmt::format("the device came back with another camera or mode ({}x{})", other.width, other.height);
    device->reset();
    device = Error{ErrorKind::device, what};
  }
  if (device) {
    ++attempts_;
    device_ = std::move(*device);
    place_ = device_->place();
    judge_.restart();
    opened_ns_ = useful_ns_ = monotonic_ns();
    last_frame_ns_ = 0;
    device_number_ = -1;
    pause_ns_ = std::min(2 * pause_ns_, kMostPause);  // until a frame proves that it works
    monitor_.reopened();
    monitor_.set_state(DeviceState::opening);
    return;
  }
  const bool absent = device.error().kind == ErrorKind::absent;
  if (!absent) ++attempts_;
  monitor_.set_state(absent ? DeviceState::absent : DeviceState::reopening);
  const bool news = device.error().message != reason_;
  reason_ = device.error().message;
  if (news) item.fault = reason_;
  next_try_ns_ = monotonic_ns() + pause_ns_;
  pause_ns_ = std::min(2 * pause_ns_, kMostPause);
}

}  // namespace pliant
