#include "tests/soak/faulty_source.hpp"

#include <utility>

#include "drivers/simulated/simulated.hpp"
#include "firmware-app/measure/clock.hpp"

namespace pliant::soak {

namespace {

/// Frame n has a fault when n mod `period` is `phase`. The periods share no factor, so that the faults meet
/// in every combination.
struct Fault {
  std::int64_t period, phase;
  [[nodiscard]] bool in(std::int64_t n) const { return n % period == phase; }
};
constexpr Fault kBroken{97, 13};                         // the driver says so itself
constexpr Fault kEmpty{211, 50};                         // no reading
constexpr Fault kNoise{503, 100};                        // readings that are no surface
constexpr Fault kWrongSize{1009, 500};                   // another mode
constexpr Fault kSilence{701, 350};                      // nothing for a while
constexpr Fault kStampBack{2003, 900};                   // a clock set back
constexpr std::int64_t kBurstPeriod = 1511, kBurst = 6;  // frames all at once
constexpr std::int64_t kGonePeriod = 5003, kGone = 25;   // only the wall is seen

}  // namespace

Result<std::vector<std::vector<std::uint16_t>>> FaultySource::draw(const std::string& uri, int pictures,
                                                                   Intrinsics& camera) {
  Result<std::unique_ptr<SimulatedSource>> source = open_simulated(uri);
  if (!source) return source.error();
  camera = (*source)->intrinsics();
  std::vector<std::vector<std::uint16_t>> drawn;
  SourceItem item;
  while (static_cast<int>(drawn.size()) < pictures) {
    (*source)->next(1000, item);
    if (item.event == SourceEvent::end) break;
    if (item.event != SourceEvent::frame) continue;
    std::vector<std::uint16_t>& picture = drawn.emplace_back();
    for (int v = 0; v < item.frame.height; ++v) {
      const std::uint16_t* row = item.frame.depth + static_cast<std::ptrdiff_t>(v) * item.frame.stride;
      picture.insert(picture.end(), row, row + item.frame.width);
    }
  }
  return drawn;
}

FaultySource::FaultySource(std::vector<std::vector<std::uint16_t>> pictures, const Intrinsics& camera,
                           std::int64_t frames, const std::atomic<std::int64_t>& seen)
    : pictures_(std::move(pictures)),
      empty_(pictures_.front().size(), 0),
      wall_(pictures_.front().size(), 1500),
      noise_(pictures_.front().size()),
      camera_(camera),
      frames_(frames),
      seen_(seen) {
  std::uint32_t state = 1;
  for (std::uint16_t& reading : noise_) {
    state = state * 1664525 + 1013904223;
    reading = static_cast<std::uint16_t>(400 + (state >> 16) % 3000);
  }
}

const std::vector<std::uint16_t>& FaultySource::picture(std::int64_t number) const {
  if (number % kGonePeriod >= kGonePeriod - kGone) return wall_;
  if (kEmpty.in(number)) return empty_;
  if (kNoise.in(number)) return noise_;
  const auto count = static_cast<std::int64_t>(pictures_.size());
  const std::int64_t turn = number % (2 * count);
  return pictures_[static_cast<std::size_t>(turn < count ? turn : 2 * count - 1 - turn)];
}

void FaultySource::wait_for_tracking() const {
  const std::int64_t until = monotonic_ns() + 50'000'000;
  while (seen_.load(std::memory_order_acquire) == seen_before_ && monotonic_ns() < until)
    sleep_until_ns(monotonic_ns() + 30'000);
}

void FaultySource::next(int timeout_ms, SourceItem& item) {
  if (wait_) wait_for_tracking();
  wait_ = false;
  item.fault.clear();
  if (number_ == frames_) {
    item.event = SourceEvent::end;
    return;
  }
  if (kSilence.in(number_) && silent_at_ != number_) {
    silent_at_ = number_;
    sleep_until_ns(monotonic_ns() + std::int64_t{timeout_ms} * 10'000);  // a hundredth of it will do here
    item.event = SourceEvent::timeout;
    return;
  }
  const std::int64_t n = number_++;
  if (kBroken.in(n)) {
    item.event = SourceEvent::bad_frame;
    item.fault = "the picture is not whole";
    return;
  }
  const std::vector<std::uint16_t>& pixels = picture(n);
  item.event = SourceEvent::frame;
  item.frame.depth = pixels.data();
  item.frame.width = item.frame.stride = camera_.width;
  item.frame.height = kWrongSize.in(n) ? camera_.height / 2 : camera_.height;
  item.frame.number = n;
  item.frame.utime = (kStampBack.in(n) ? n - 1000 : n) * 33'333;
  wait_ = n % kBurstPeriod >= kBurst && !kEmpty.in(n) && !kWrongSize.in(n);
  seen_before_ = seen_.load(std::memory_order_acquire);
}

}  // namespace pliant::soak
