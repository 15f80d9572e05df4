#include "firmware-app/pipeline/run_pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include "core/memory/workspace.hpp"
#include "firmware-app/measure/clock.hpp"
#include "firmware-app/pipeline/memory_block.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"
#include "firmware-app/pipeline/touch_program.hpp"

namespace pliant {

namespace {

/// What the sending thread tells: its costs and when a frame's messages are out.
class SendWatch {
 public:
  SendWatch(PathCost& cost, LatencyMeter& latency) : cost_(cost), latency_(latency) {}
  [[nodiscard]] SendObserver observer() {
    return {.thread_started = [](void* self) { of(self).watch_.emplace(of(self).cost_); },
            .group_sent =
                [](void* self, std::int64_t utime) {
                  of(self).latency_.sent(utime);
                  of(self).watch_->update();
                },
            .thread_ends = [](void* self) { of(self).watch_.reset(); },
            .context = this};
  }

 private:
  static SendWatch& of(void* self) { return *static_cast<SendWatch*>(self); }
  PathCost& cost_;
  LatencyMeter& latency_;
  std::optional<PathWatch> watch_;
};

/// How long a source may take to come back: when the program ends, and when it goes on with the same source.
constexpr int kHangMs = 500, kHangBeforeReuseMs = 5000;

/// What the capturing thread uses, in one place that can outlive the run.
struct CaptureSide {
  MemoryBlock memory;
  FrameRing ring;
  Capture capture;
  Worker thread;  // the last: joined before the others go

  CaptureSide(DepthSource& source, const Capture::Settings& settings, FrameRing::Policy policy,
              MemoryBlock block)
      : memory(std::move(block)),
        ring(source.intrinsics(), policy, memory),
        capture(source, ring, settings) {}
  [[nodiscard]] static Result<std::unique_ptr<CaptureSide>> make(DepthSource& source,
                                                                 const Capture::Settings& settings,
                                                                 FrameRing::Policy policy) {
    Result<MemoryBlock> block = FrameRing::allocate(source.intrinsics());
    if (!block) return block.error();
    return std::make_unique<CaptureSide>(source, settings, policy, std::move(*block));
  }
};

void warn(const RunSettings& settings, const std::string& line) {
  if (settings.warn && !line.empty()) settings.warn(line);
}

void look_at_log(const RunSettings& settings, const LcmPublisher* publisher, const char* more, RunEnd& end) {
  if (publisher == nullptr || end.log_failed) return;
  const Outcome failure = publisher->log_failure();
  end.log_failed = !failure;
  if (!failure) warn(settings, failure.error().message + more);
}

/// Waits for the tracking thread, shows progress, passes a stop on, tells of a failed write as soon as it is
/// known.
void supervise(const RunSettings& settings, LiveFigures& live, const std::atomic<bool>& done,
               Capture& capture, FrameRing& ring, const FrameFiles* files, const LcmPublisher* publisher,
               RunEnd& end) {
  while (!done.load(std::memory_order_acquire)) {
    sleep_until_ns(monotonic_ns() + 20'000'000);
    live.captured.store(capture.beats(), std::memory_order_relaxed);
    if (!end.stopped && !end.left) {
      end.stopped = StopSignal::requested();
      end.left = !end.stopped && settings.leave && settings.leave();
      if (end.stopped || end.left) {
        capture.stop();
        ring.abort();
      }
    }
    if (files != nullptr && !end.files_failed) {
      const std::string failure = files->failure();
      end.files_failed = !failure.empty();
      if (end.files_failed) warn(settings, failure + "; tracking goes on without files");
    }
    look_at_log(settings, publisher, "; tracking goes on, messages are missing in the log", end);
    if (settings.progress) settings.progress(live);
  }
}

}  // namespace

Result<RunEnd> run_pipeline(DepthSource& source, const ModelView& model, const RunSettings& settings) {
  const Intrinsics& camera = source.intrinsics();
  const bool newest_wins = settings.realtime || source.live();

  RunEnd end;
  RunFigures& figures = end.figures;
  const std::size_t workspace_bytes = Tracker::workspace_bytes(model, camera, settings.track);
  figures.workspace_bytes = workspace_bytes;
  Result<MemoryBlock> workspace = MemoryBlock::allocate(workspace_bytes);
  if (!workspace) return workspace.error();
  figures.workspace_locked = workspace->locked();
  Tracker tracker;
  if (const char* fault = tracker.start(model, camera, settings.sensor, settings.track, workspace->bytes());
      fault != nullptr)
    return Error{ErrorKind::bad_input, fmt::format("the tracker cannot start: {}", fault)};
  if (settings.start_pose) tracker.start_from(*settings.start_pose);

  Result<std::unique_ptr<CaptureSide>> made_capture = CaptureSide::make(
      source, {.pace_by_stamps = settings.realtime && !source.live(), .frame_limit = settings.frame_limit},
      newest_wins ? FrameRing::Policy::newest : FrameRing::Policy::keep_all);
  if (!made_capture) return made_capture.error();
  std::unique_ptr<CaptureSide> capture_side = std::move(*made_capture);
  FrameRing& ring = capture_side->ring;
  Capture& capture = capture_side->capture;

  std::unique_ptr<FrameFiles> files;
  if (!settings.files.trajectory.empty() || !settings.files.points.empty()) {
    FrameFilesSettings file_settings = settings.files;
    file_settings.wait_for_disk = !newest_wins;
    Result<std::unique_ptr<FrameFiles>> made = FrameFiles::create(file_settings, model.positions());
    if (!made) return made.error();
    files = std::move(*made);
  }

  PathCost cost;
  LatencyMeter latency;
  SendWatch send_watch(cost, latency);
  TrackMessages messages(model.positions(), model.header().checksum);
  std::unique_ptr<LcmPublisher> publisher;
  if (settings.lcm_url != "none") {
    Result<std::unique_ptr<LcmPublisher>> made = LcmPublisher::create(
        {settings.lcm_url, settings.lcm_prefix, settings.publish_depth ? camera.width : 0,
         settings.publish_depth ? camera.height : 0, settings.add_to_log},
        model.size(), send_watch.observer());
    if (!made) return made.error();
    publisher = std::move(*made);
    warn(settings, publisher->warning());
  }
  if (publisher != nullptr) publisher->announce(model);

  LiveFigures live;
  TrackingLoop::Settings loop_settings;
  loop_settings.budget_ns = newest_wins ? static_cast<std::int64_t>(settings.budget_ms * 1e6) : 0;
  loop_settings.wait_for_publisher = !newest_wins;
  loop_settings.hash = settings.hash;
  loop_settings.publish_depth = settings.publish_depth;
  loop_settings.camera = camera;
  loop_settings.version = settings.version;
  loop_settings.source = settings.source_name;
  loop_settings.model_id = model.header().checksum;
  loop_settings.workspace_bytes = figures.workspace_bytes;
  TrackingLoop loop(
      {ring, capture, tracker, messages, publisher.get(), files.get(), latency, cost, live, settings.witness},
      loop_settings);

  std::atomic<bool> done{false};
  Worker tracking_thread;
  std::string warning;
  Outcome started = tracking_thread.start(
      {.name = "pliant-track", .priority = settings.priority, .affinity = settings.affinity},
      [&] {
        loop.run(figures);
        done.store(true, std::memory_order_release);
      },
      warning);
  if (!started) return started.error();
  warn(settings, warning);
  static_cast<void>(touch_program());
  if (settings.lock_memory) warn(settings, lock_memory());
  // Above tracking: taking a frame from the device is short, and coming late to it loses frames.
  warning.clear();
  started = capture_side->thread.start(
      {.name = "pliant-capture",
       .priority = settings.priority > 0 ? std::min(settings.priority + 1, 99) : 0,
       .affinity = {}},
      [&capture] { capture.run(); }, warning);
  warn(settings, warning);
  if (!started) {
    ring.close();
    return started.error();
  }

  supervise(settings, live, done, capture, ring, files.get(), publisher.get(), end);
  tracking_thread.join();
  capture.stop();
  ring.abort();
  if (!capture_side->thread.join_within(end.left ? kHangBeforeReuseMs : kHangMs)) {
    // The thread still uses what is here: it stays until the process ends.
    end.source_hangs = true;
    static_cast<void>(capture_side.release());
  }
  loop.publish_end(figures);
  if (publisher != nullptr) {
    publisher->finish();
    figures.sent = publisher->counters();
    look_at_log(settings, publisher.get(), "", end);
    publisher.reset();
  }
  if (files != nullptr) {
    const Outcome closed = files->finish();
    if (!closed && !end.files_failed) warn(settings, closed.error().message);
    end.files_failed = end.files_failed || !closed;
    figures.files_left_out = static_cast<std::int64_t>(files->left_out());
  }
  end.taken = capture.taken();
  end.device_lost = capture.device() == DeviceState::lost;
  end.fault = capture.fault();
  figures.dropped = static_cast<std::int64_t>(ring.dropped());
  figures.bad_frames += capture.bad_frames();
  figures.latency = latency.whole();
  figures.heap_calls = cost.heap_calls.load();
  figures.page_faults = cost.page_faults.load();
  figures.heap_watched = heap_is_watched();
  figures.resident_bytes = peak_resident_bytes();
  return end;
}

}  // namespace pliant
