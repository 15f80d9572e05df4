#include "firmware-app/commands/capture_pictures.hpp"

#include <fmt/format.h>

#include <memory>

#include "firmware-app/commands/capture_guide.hpp"
#include "firmware-app/commands/capture_show.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/place_views.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant {

Taken take_pictures(DepthSource& source, const CaptureOptions& options, ObjectCapture& capture) {
  Taken taken;
  CaptureGuide guide(source.rate());
  std::string warning, told;
  std::int64_t told_at = 0;
  const std::unique_ptr<CaptureShow> show =
      CaptureShow::open(options.lcm_url, options.source, source.intrinsics(), source.rate(), warning);
  if (!warning.empty()) print_warning(warning);
  LiveLine line;
  SourceItem item;
  std::int64_t count = 0;
  while (!StopSignal::requested() && (options.frames < 0 || count < options.frames)) {
    source.next(100, item);
    taken.last = item.event;
    if (!item.fault.empty()) taken.fault = item.fault;
    if (item.event == SourceEvent::end || item.event == SourceEvent::lost) break;
    if (item.event == SourceEvent::timeout) continue;
    ++count;
    if (item.event == SourceEvent::bad_frame) {
      ++taken.bad_frames;
      continue;
    }
    const StampedPose* const known =
        options.known.empty() ? nullptr
                              : pose_at(options.known, static_cast<double>(item.frame.utime) * 1e-6);
    if (!options.known.empty() && known == nullptr) {
      ++taken.bad_frames;
      continue;
    }
    const CaptureStatus& status =
        known != nullptr ? capture.process(item.frame, known->transform()) : capture.process(item.frame);
    guide.take(status, capture.coverage());
    if (const std::string advice = guide.advice(); !advice.empty()) {
      line.clear();
      print_warning(advice);
      told = " | " + advice;
      told_at = count;
    }
    if (static_cast<double>(count - told_at) > 5 * source.rate()) told.clear();
    if (show != nullptr) show->show(item.frame, capture, status, guide.line() + told);
    line.show(guide.line());
  }
  line.clear();
  if (show != nullptr)
    if (const Outcome logged = show->finish(); !logged) {
      print_warning(logged.error().message);
      taken.log_failed = true;
    }
  return taken;
}

Result<Taken> take_views(DepthSource& source, const CaptureOptions& options, const SensorDescription& sensor,
                         ObjectCapture& capture) {
  std::vector<std::vector<std::uint16_t>> pictures;
  std::vector<DepthFrame> views;
  SourceItem item;
  for (source.next(0, item); item.event == SourceEvent::frame && !StopSignal::requested();
       source.next(0, item)) {
    const std::ptrdiff_t pixels = std::ptrdiff_t{item.frame.stride} * item.frame.height;
    pictures.emplace_back(item.frame.depth, item.frame.depth + pixels);
    views.push_back(item.frame);
    views.back().depth = pictures.back().data();
  }
  LiveLine line;
  const Result<std::vector<std::size_t>> left =
      place_views(views, source.intrinsics(), sensor, capture, [&](std::size_t placed) {
        line.show(fmt::format("placing the views: {} of {}", placed, views.size()));
      });
  line.clear();
  if (!left) return left.error();
  for (const std::size_t i : *left)
    print_warning(fmt::format("{}: left out, {}", options.views[i],
                              StopSignal::requested() ? "the capture was ended before"
                              : capture.figures().fused == 0
                                  ? "no object stands before the background"
                                  : "its place among the other views is not clear; give --poses, or views "
                                    "that share more"));
  return Taken{};
}

}  // namespace pliant
