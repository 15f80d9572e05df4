#include "firmware-app/outputs/run_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace pliant {

namespace {

using Json = nlohmann::ordered_json;

/// Nanoseconds as microseconds with one digit behind the point.
double microseconds(std::int64_t nanoseconds) {
  return std::round(static_cast<double>(nanoseconds) / 100) / 10;
}

Json times(const Histogram& histogram) {
  return {{"median_us", microseconds(histogram.median())},
          {"p99_us", microseconds(histogram.p99())},
          {"max_us", microseconds(histogram.max())}};
}

double milliseconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-6;
}

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

std::string time_row(const char* name, const Histogram& histogram) {
  if (histogram.count() == 0) return {};
  return fmt::format("  {:<10} {:>9.3f} {:>9.3f} {:>9.3f} {:>9}\n", name, milliseconds(histogram.median()),
                     milliseconds(histogram.p99()), milliseconds(histogram.max()), histogram.count());
}

}  // namespace

std::string stats_json(const RunFigures& f) {
  Json stages;
  for (int i = 0; i <= kStageCount; ++i)
    stages[kStageNames[static_cast<std::size_t>(i)]] = times(f.profile.stage(i));
  Json stats = {{"frames", f.frames()},
                {"tracked", f.tracked},
                {"lost", f.lost},
                {"searching", f.searching},
                {"dropped", f.dropped},
                {"bad_frames", f.bad_frames},
                {"send_failures", f.sent.failures},
                {"stages", stages},
                {"latency_us", times(f.latency)}};
  // A build with a sanitizer has no count to tell; a zero would be a claim.
  stats["heap_calls_after_start"] = f.heap_watched ? Json(f.heap_calls) : Json(nullptr);
  stats["page_faults_after_start"] = f.page_faults;
  stats["workspace_bytes"] = f.workspace_bytes;
  stats["rss_bytes"] = f.resident_bytes;
  stats["output_sha256"] = f.output_sha256;
  return stats.dump(2) + "\n";
}

std::string closing_table(const RunFigures& f) {
  std::string text = fmt::format("frames     {:>6}  tracked {}, lost {}, searching {}", f.frames(), f.tracked,
                                 f.lost, f.searching);
  if (f.dropped > 0) text += fmt::format(", dropped {}", f.dropped);
  if (f.bad_frames > 0) text += fmt::format(", bad {}", f.bad_frames);
  text += "\n";
  if (f.first_tracked >= 0) text += fmt::format("found      in frame {}\n", f.first_tracked);
  if (f.seconds > 0 && f.frames() > 0)
    text += fmt::format("rate       {:>6.1f}  frames a second over {:.1f} s\n",
                        static_cast<double>(f.frames()) / f.seconds, f.seconds);
  text += "stage, ms     median       p99       max    frames\n";
  for (int i = 0; i < kStageCount; ++i)
    text += time_row(kStageNames[static_cast<std::size_t>(i)], f.profile.stage(i));
  text += time_row("total", f.profile.total());
  text += time_row("latency", f.latency);
  if (f.deadline_misses > 0)
    text += fmt::format("deadline   {:>6}  frames over budget, work level down to {:.2f}\n",
                        f.deadline_misses, f.least_work_level);
  text +=
      fmt::format("memory     {:>6.1f}  MB resident, workspace {:.1f} MB{}\n", megabytes(f.resident_bytes),
                  megabytes(f.workspace_bytes), f.workspace_locked ? " (locked)" : "");
  text += f.heap_watched ? fmt::format("heap       {:>6}  calls", f.heap_calls) : "heap        not counted";
  text += fmt::format(" and {} page faults on the path of a frame\n", f.page_faults);
  if (f.sent.messages > 0 || f.sent.unsent > 0 || f.sent.failures > 0)
    text +=
        fmt::format("LCM        {:>6}  messages, {:.1f} MB, {} frames unsent, {} refused\n", f.sent.messages,
                    megabytes(static_cast<std::uint64_t>(f.sent.bytes)), f.sent.unsent, f.sent.failures);
  if (f.files_left_out > 0)
    text += fmt::format("files      {:>6}  frames left out: the disk did not keep up\n", f.files_left_out);
  return text;
}

std::string status_line(const LiveFigures& live, std::int64_t frame_count) {
  const std::int64_t frame = live.frame.load(std::memory_order_relaxed);
  std::string text = frame_count > 0 ? fmt::format("frame {}/{}", frame + 1, frame_count)
                                     : fmt::format("frame {}", frame + 1);
  const TrackState state = live.state.load(std::memory_order_relaxed);
  text += fmt::format("  {}", state_word(state));
  if (state == TrackState::tracking)
    text += fmt::format("  {} {}, confidence {:.2f}", live.regions.load(std::memory_order_relaxed),
                        live.regions.load(std::memory_order_relaxed) == 1 ? "region" : "regions",
                        live.confidence.load(std::memory_order_relaxed));
  text += fmt::format(
      "  {:.2f} ms  tracked {} of {}", milliseconds(live.last_total_ns.load(std::memory_order_relaxed)),
      live.tracked.load(std::memory_order_relaxed), live.frames.load(std::memory_order_relaxed));
  return text;
}

}  // namespace pliant
