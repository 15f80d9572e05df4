// Frames a second over spans that are long enough to tell it.
#pragma once

#include <cstdint>

namespace pliant {

class FrameRate {
 public:
  /// A shorter span holds so few frames that the moment it was cut at decides the value.
  static constexpr std::int64_t kShortestSpanNs = 500'000'000;

  explicit FrameRate(std::int64_t now_ns = 0) noexcept : since_ns_(now_ns) {}

  /// `frames`: counted since the start. Over the time since the value before, which is given once more where
  /// that was too short ago; 0 until there is one.
  double update(std::int64_t now_ns, std::int64_t frames) noexcept {
    if (now_ns - since_ns_ >= kShortestSpanNs) {
      rate_ = static_cast<double>(frames - frames_) * 1e9 / static_cast<double>(now_ns - since_ns_);
      since_ns_ = now_ns;
      frames_ = frames;
    }
    return rate_;
  }

 private:
  std::int64_t since_ns_, frames_ = 0;
  double rate_ = 0;
};

}  // namespace pliant
