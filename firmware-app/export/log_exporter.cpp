#include "firmware-app/export/log_exporter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "drivers/lcm/lcm_log.hpp"
#include "drivers/lcm/lcm_url.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMostModels = 16;

/// "_POSE" of "PLIANT_POSE"; empty where the channel is another tracker's or no tracker's.
std::string_view suffix_of(std::string_view channel, std::string_view prefix) {
  if (!channel.starts_with(prefix)) return {};
  const std::string_view suffix = channel.substr(prefix.size());
  for (int kind = 0; kind < kMessageKinds; ++kind)
    if (suffix == channel_suffix(static_cast<MessageKind>(kind))) return suffix;
  return {};
}

class Walker {
 public:
  Walker(std::span<const ReceivedModel> models, std::span<LogExporter* const> exporters)
      : models_(models), exporters_(exporters) {}

  Outcome take(const LcmLogEvent& event, std::string_view suffix) {
    const auto is = [&](MessageKind kind) { return suffix == channel_suffix(kind); };
    const std::int64_t at = event.utime;
    if (is(MessageKind::pose) && decode(event.body, pose_))
      return tell([&](LogExporter& out) { return out.pose(at, pose_); });
    if (is(MessageKind::regions) && decode(event.body, regions_))
      return frames_.take(regions_) ? tell_frame(at) : success();
    if (is(MessageKind::deformed) && decode(event.body, deformed_))
      return frames_.take(deformed_) ? tell_frame(at) : success();
    if (is(MessageKind::status) && decode(event.body, status_))
      return tell([&](LogExporter& out) { return out.status(at, status_); });
    if (is(MessageKind::depth) && decode(event.body, depth_)) {
      if (!depths_.take(depth_)) return success();
      return tell([&](LogExporter& out) { return out.depth(at, depths_.picture()); });
    }
    if (is(MessageKind::model) && decode(event.body, model_)) return success();
    ++figures_.garbage;
    return success();
  }

  [[nodiscard]] LogFigures figures() const {
    LogFigures figures = figures_;
    figures.incomplete = frames_.incomplete() + depths_.incomplete();
    return figures;
  }

 private:
  template <typename Call>
  Outcome tell(const Call& call) {
    for (LogExporter* exporter : exporters_)
      if (Outcome done = call(*exporter); !done) return done;
    return success();
  }

  Outcome tell_frame(std::int64_t at) {
    const ReceivedFrame& frame = frames_.frame();
    ++figures_.frames;
    figures_.tracked += frame.state == TrackState::tracking ? 1 : 0;
    const auto model = std::find_if(models_.begin(), models_.end(), [&](const ReceivedModel& candidate) {
      return candidate.model_id == frame.model_id;
    });
    positions_.clear();
    if (model != models_.end()) place_points(frame, *model, positions_);
    const ReceivedModel* known = positions_.empty() ? nullptr : &*model;
    return tell([&](LogExporter& out) { return out.frame(at, frame, known, positions_); });
  }

  std::span<const ReceivedModel> models_;
  std::span<LogExporter* const> exporters_;
  FrameAssembler frames_;
  PictureAssembler depths_;
  std::vector<Point3f> positions_;
  LogFigures figures_;
  PoseMessage pose_;
  RegionsMessage regions_;
  DeformedMessage deformed_;
  StatusMessage status_;
  DepthMessage depth_;
  ModelMessage model_;
};

Error nothing_in(const std::string& path, std::string_view prefix, const std::set<std::string>& others) {
  std::string message = fmt::format("'{}' holds nothing on the channels {}_*", path, prefix);
  if (!others.empty()) message += fmt::format("; give --prefix {}", fmt::join(others, " or --prefix "));
  return {ErrorKind::bad_input, message};
}

}  // namespace

Result<std::vector<ReceivedModel>> models_in_log(const std::string& path, std::string_view prefix) {
  Result<LcmLog> log = LcmLog::open(path);
  if (!log) return log.error();
  std::vector<ReceivedModel> models;
  ModelAssembler assembler;
  ModelMessage message;
  LcmLogEvent event;
  while (models.size() < kMostModels && log->next(event)) {
    if (suffix_of(event.channel, prefix) != channel_suffix(MessageKind::model)) continue;
    if (!decode(event.body, message) || !assembler.take(message)) continue;
    const ReceivedModel& model = assembler.model();
    if (std::none_of(models.begin(), models.end(),
                     [&](const ReceivedModel& known) { return known.model_id == model.model_id; }))
      models.push_back(model);
  }
  return models;
}

Result<LogFigures> walk_log(const std::string& path, std::string_view prefix,
                            std::span<const ReceivedModel> models, std::span<LogExporter* const> exporters) {
  Result<LcmLog> log = LcmLog::open(path);
  if (!log) return log.error();
  Walker walker(models, exporters);
  std::set<std::string> others;
  bool any = false;
  LcmLogEvent event;
  while (log->next(event)) {
    const std::string_view suffix = suffix_of(event.channel, prefix);
    if (suffix.empty()) {
      const std::size_t end = event.channel.rfind("_REGIONS");
      if (end == std::string::npos || others.size() >= 4) continue;
      // A name may hold anything: only what --prefix would take is advised.
      if (std::string other = event.channel.substr(0, end); check_channel_prefix(other))
        others.insert(std::move(other));
      continue;
    }
    any = true;
    if (Outcome told = walker.take(event, suffix); !told) return told.error();
  }
  if (!any) return nothing_in(path, prefix, others);
  for (LogExporter* exporter : exporters)
    if (Outcome done = exporter->finish(); !done) return done.error();
  LogFigures figures = walker.figures();
  figures.damages = log->damages();
  return figures;
}

}  // namespace pliant
