// Where the time of a frame goes.
#pragma once

#include <array>
#include <cstdint>

#include "core/track_result.hpp"
#include "firmware-app/measure/histogram.hpp"

namespace pliant {

/// The stages' names as they stand in stats and messages, in the order of Stage; "total" follows them.
inline constexpr std::array<const char*, kStageCount + 1> kStageNames = {
    "surface", "predict", "associate", "align", "label", "regroup", "deform", "detect", "total"};

/// Times the stages of Tracker::process(). One thread uses it; no heap. A stage that is passed several times
/// in a frame counts with the sum.
class StageProfile {
 public:
  /// To be given to Tracker::observe(); the profile must outlive the tracker's use of it.
  [[nodiscard]] StageObserver observer() noexcept;
  void begin_frame() noexcept;
  /// Takes the frame into the histograms; `tracked` decides whether its total counts.
  void end_frame(bool tracked) noexcept;

  /// Takes the last frame of another profile in.
  void add_last_of(const StageProfile& other, bool tracked) noexcept;
  void clear() noexcept {
    for (Histogram& histogram : histograms_) histogram.clear();
  }

  [[nodiscard]] const Histogram& stage(int index) const noexcept {
    return histograms_[static_cast<std::size_t>(index)];
  }
  /// process() over tracked frames.
  [[nodiscard]] const Histogram& total() const noexcept { return histograms_[kStageCount]; }
  /// Duration of the last frame's process(), whatever its state. Nanoseconds.
  [[nodiscard]] std::int64_t last_total() const noexcept { return last_total_; }
  /// Time of a stage in the last frame, -1 when it was not passed. Nanoseconds.
  [[nodiscard]] std::int64_t last(int index) const noexcept {
    return spent_[static_cast<std::size_t>(index)];
  }

 private:
  static void stage_done(void* context, Stage stage) noexcept;

  std::array<Histogram, kStageCount + 1> histograms_;
  std::array<std::int64_t, kStageCount> spent_{};
  std::int64_t begin_ = 0;
  std::int64_t stamp_ = 0;
  std::int64_t last_total_ = 0;
};

}  // namespace pliant
