#include "firmware-app/pipeline/stream_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pliant {

namespace {

// Of neighbouring readings of a sound frame, those at the edges of objects differ by more than the tolerance:
// up to one in seven in cluttered rooms. Of noise, most do.
constexpr double kMostUnlike = 0.4;
// And of a sound frame's readings at least this share has a neighbour with a reading; salt has few.
constexpr double kLeastPaired = 0.25;
constexpr int kFewestSamples = 100;  // fewer readings than these prove nothing
constexpr int kStep = 4;

}  // namespace

StreamJudge::StreamJudge(const Intrinsics& camera, const SensorDescription& sensor, double rate)
    : width_(camera.width),
      height_(camera.height),
      promised_ns_(static_cast<std::int64_t>(1e9 / std::clamp(rate, 1.0, 1000.0))),
      frame_time_ns_(promised_ns_) {
  for (std::size_t i = 0; i < tolerance_.size(); ++i) {
    const double z = (static_cast<double>(i) + 0.5) * 256 / camera.depth_scale;
    const double metres = 6 * sensor.sigma(std::min(z, sensor.far_limit)) + 0.03 * z;
    tolerance_[i] = static_cast<std::uint16_t>(std::clamp(metres * camera.depth_scale, 1.0, 65535.0));
  }
}

void StreamJudge::restart() noexcept {
  frame_time_ns_ = promised_ns_;
  hash_known_ = lag_known_ = slow_ = false;
  last_arrival_ns_ = 0;
  interval_count_ = 0;
}

StreamFault StreamJudge::judge(const DepthFrame& frame, std::int64_t arrival_ns,
                               std::int64_t arrival_us) noexcept {
  note_interval(arrival_ns);
  if (frame.width != width_ || frame.height != height_) return StreamFault::wrong_size;
  const Content content = read(frame);
  const bool stuck = hash_known_ && content.hash == hash_;
  hash_ = content.hash;
  hash_known_ = true;
  if (content.zero) return StreamFault::zero;
  if (stuck) return StreamFault::stuck;
  if (is_delayed(frame, arrival_us)) return StreamFault::delayed;
  if (is_noise(frame)) return StreamFault::noise;
  return slow_ ? StreamFault::slow : StreamFault::none;
}

StreamJudge::Content StreamJudge::read(const DepthFrame& frame) noexcept {
  // Four sums of their own, so that one multiplication need not wait for the other.
  constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15U;
  std::array<std::uint64_t, 4> sums = {1, 2, 3, 4};
  std::uint64_t any = 0;
  const auto row_bytes = static_cast<std::size_t>(frame.width) * sizeof(std::uint16_t);
  for (int v = 0; v < frame.height; ++v) {
    const void* row = frame.depth + static_cast<std::ptrdiff_t>(v) * frame.stride;
    const auto* bytes = static_cast<const unsigned char*>(row);
    std::size_t at = 0;
    std::array<std::uint64_t, 4> words{};
    for (; at + sizeof words <= row_bytes; at += sizeof words) {
      std::memcpy(words.data(), bytes + at, sizeof words);
      for (std::size_t k = 0; k < words.size(); ++k) {
        any |= words[k];
        sums[k] = (sums[k] ^ words[k]) * kFactor;
      }
    }
    words = {};
    std::memcpy(words.data(), bytes + at, row_bytes - at);
    for (std::size_t k = 0; k < words.size(); ++k) {
      any |= words[k];
      sums[k] = (sums[k] ^ words[k]) * kFactor;
      sums[k] ^= sums[k] >> 29;
    }
  }
  std::uint64_t hash = 0;
  for (const std::uint64_t sum : sums) hash = (hash ^ sum ^ (sum >> 32)) * kFactor;
  return {hash, any == 0};
}

bool StreamJudge::is_noise(const DepthFrame& frame) const noexcept {
  int samples = 0, pairs = 0, unlike = 0;
  const auto compare = [&](int z, int other) {
    if (other == 0) return;
    ++pairs;
    const int tolerance = tolerance_[static_cast<std::size_t>(z) >> 8];
    if (z - other > tolerance || other - z > tolerance) ++unlike;
  };
  for (int v = 0; v + 1 < frame.height; v += kStep) {
    const std::uint16_t* row = frame.depth + static_cast<std::ptrdiff_t>(v) * frame.stride;
    for (int u = 0; u + 1 < frame.width; u += kStep) {
      if (row[u] == 0) continue;
      ++samples;
      compare(row[u], row[u + 1]);
      compare(row[u], row[u + frame.stride]);
    }
  }
  if (samples < kFewestSamples) return false;
  return pairs < kLeastPaired * 2 * samples || unlike > kMostUnlike * pairs;
}

bool StreamJudge::is_delayed(const DepthFrame& frame, std::int64_t arrival_us) noexcept {
  const std::int64_t lag = arrival_us - frame.utime;
  if (!lag_known_ || lag < least_lag_us_) {
    least_lag_us_ = lag;
    lag_known_ = true;
  }
  return (lag - least_lag_us_) * 1000 > kMostDelay * promised_ns_ || lag * 1000 > kMostAge * frame_time_ns_;
}

void StreamJudge::note_interval(std::int64_t arrival_ns) noexcept {
  if (last_arrival_ns_ != 0) {
    intervals_[interval_count_ % kIntervals] = arrival_ns - last_arrival_ns_;
    ++interval_count_;
  }
  last_arrival_ns_ = arrival_ns;
  if (interval_count_ < kIntervals) return;
  std::array<std::int64_t, kIntervals> sorted = intervals_;
  std::nth_element(sorted.begin(), sorted.begin() + kIntervals / 2, sorted.end());
  const std::int64_t median = sorted[kIntervals / 2];
  slow_ = static_cast<double>(median) > kSlow * static_cast<double>(promised_ns_);
  frame_time_ns_ = slow_ ? median : promised_ns_;
}

}  // namespace pliant
