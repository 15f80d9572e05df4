// A depth device that may stall, go and come back: the one state machine of all live sources.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "drivers/depth_source/arrival_signal.hpp"
#include "drivers/depth_source/depth_source.hpp"
#include "firmware-app/pipeline/stream_judge.hpp"

namespace pliant {

/// What LiveSource drives. Times are seconds.
struct LiveSettings {
  /// Opens the device; ErrorKind::absent where it is not there, ErrorKind::device where it cannot be opened.
  std::function<Result<std::unique_ptr<DepthSource>>()> open;
  /// Reset of the port at which the device was last (DepthSource::place()), the last resort for one that is
  /// there and gives nothing; may be empty.
  std::function<void(const std::string& place)> reset;
  /// Delayed frames are passed on, to who keeps frames instead of acting on them.
  bool late_is_welcome = false;
  std::shared_ptr<ArrivalSignal> arrivals;  ///< devices came or went; may be null
  double patience = 60;                     ///< without a usable frame before the device is lost for good
  double first_frame = 3;                   ///< for the first frame after opening
  double most_stall = 1;    ///< before a stalled device is given up and opened again; at least 15 frame times
  double most_useless = 3;  ///< of frames that cannot be used before the device is opened again
  /// A longer time in which nobody asked, or a device that was asked did not answer, is this program's: it
  /// was stopped, or the machine stood still. It counts for neither `patience` nor `most_useless`.
  double most_pause = 3;
};

/// absent → opening → streaming → stalled → lost → reopening, with growing pauses. Frames are numbered here,
/// so that numbers go on when the device comes back, and judged: one that must not be tracked is a bad_frame.
/// next() brings `timeout` with a fault at once when the device stalls, is lost or could not be opened, and
/// `lost` when patience is at its end. While opening it may take longer than its timeout.
class LiveSource final : public DepthSource {
 public:
  /// Opens the device; its error where that fails.
  [[nodiscard]] static Result<std::unique_ptr<LiveSource>> open(LiveSettings settings);

  [[nodiscard]] const Intrinsics& intrinsics() const override { return camera_; }
  [[nodiscard]] const SensorDescription& sensor() const override { return sensor_; }
  [[nodiscard]] bool live() const override { return true; }
  [[nodiscard]] double rate() const override { return rate_; }
  [[nodiscard]] const DeviceMonitor* monitor() const override { return &monitor_; }
  void next(int timeout_ms, SourceItem& item) override;
  void close() override;

  /// Pauses between attempts to open, ns.
  static constexpr std::int64_t kFirstPause = 100'000'000, kMostPause = 1'000'000'000;
  /// Attempts without a usable frame before each reset of the port.
  static constexpr int kAttemptsBeforeReset = 3;

 private:
  LiveSource(LiveSettings settings, std::unique_ptr<DepthSource> device);
  void leave_out_pause();
  void receive(std::int64_t until_ns, SourceItem& item);
  void take(SourceItem& item, std::int64_t now);
  void watch_silence(std::int64_t now, SourceItem& item);
  void lose(std::string reason, SourceItem& item);
  void try_to_open(std::int64_t until_ns, SourceItem& item);
  void attempt(SourceItem& item);
  [[nodiscard]] std::int64_t stall_ns() const noexcept { return 3 * judge_.frame_time_ns(); }
  [[nodiscard]] std::int64_t loss_ns() const noexcept;

  LiveSettings settings_;
  std::unique_ptr<DepthSource> device_;
  Intrinsics camera_;
  SensorDescription sensor_;
  double rate_;
  StreamJudge judge_;
  DeviceMonitor monitor_;
  std::int64_t number_ = 0;          // of the next frame
  std::int64_t device_number_ = -1;  // the device's own of the latest, of this opening
  std::int64_t opened_ns_ = 0;       // when the device was opened
  std::int64_t last_frame_ns_ = 0;   // of this opening; 0 before the first
  std::int64_t useful_ns_ = 0;       // the latest moment that the stream was usable, or begun
  std::int64_t alive_ns_ = 0;        // as useful_ns_, but not begun anew by opening
  std::int64_t sound_ns_ = 0;        // the latest frame that was passed on
  std::int64_t looked_ns_ = 0;       // when this program was last known to run
  std::int64_t next_try_ns_ = 0, pause_ns_ = kFirstPause;
  std::uint64_t arrivals_seen_ = 0;
  int attempts_ = 0;
  std::string place_;   // of the device when it was open last
  std::string reason_;  // why the device is not open
  bool asked_ = false;  // for a frame
  bool closed_ = false;
};

}  // namespace pliant
