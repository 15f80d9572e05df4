#include "firmware-app/demo/snapshots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "drivers/images/png.hpp"
#include "firmware-app/demo/canvas.hpp"
#include "firmware-app/outputs/run_report.hpp"

namespace pliant::demo {

namespace {

constexpr RegionColour kWhite{255, 255, 255}, kBlack{0, 0, 0};

/// Near bright, far dark, no reading black, between the nearest and the farthest readings of the picture but
/// for a few per cent.
void draw_depth(std::span<const std::uint16_t> depth, Canvas& canvas) {
  std::vector<std::uint16_t> readings;
  for (const std::uint16_t d : depth)
    if (d != 0) readings.push_back(d);
  if (readings.empty()) return;
  std::sort(readings.begin(), readings.end());
  const double near = readings[readings.size() / 50],
               far = readings[readings.size() - 1 - readings.size() / 20];
  const double span = std::max(far - near, 1.0);
  std::size_t i = 0;
  for (int v = 0; v < canvas.height(); ++v)
    for (int u = 0; u < canvas.width(); ++u, ++i) {
      if (depth[i] == 0) continue;
      const double grey = 60 + 180 * std::clamp((far - depth[i]) / span, 0.0, 1.0);
      const auto level = static_cast<std::uint8_t>(grey);
      canvas.set(u, v, {level, level, level});
    }
}

struct KeyRow {
  std::string words;
  int label = kNotObserved;  ///< not observed: without a colour, since such points are not drawn
};

void draw_key(std::span<const std::int8_t> labels, const std::string& title, Canvas& canvas) {
  constexpr int kRow = 22, kLeft = 10, kTop = 10, kIndent = 24;
  std::array<int, 256> count{};
  for (const std::int8_t label : labels) ++count[static_cast<std::size_t>(label + 128)];
  std::vector<KeyRow> rows;
  for (int label = 127; label >= -128; --label) {
    const int n = count[static_cast<std::size_t>(label + 128)];
    if (n == 0) continue;
    const char* how = label == kNotObserved ? " points, not drawn" : " points";
    rows.push_back({fmt::format("{}: {}{}", region_word(label), n, how), label});
  }
  int width = Canvas::text_width(title);
  for (const KeyRow& row : rows) width = std::max(width, kIndent + Canvas::text_width(row.words));
  canvas.box(kLeft - 6, kTop - 6, width + 12, (static_cast<int>(rows.size()) + 1) * kRow + 4, kBlack, 0.65);
  canvas.text(kLeft, kTop, title, kWhite);
  int v = kTop;
  for (const KeyRow& row : rows) {
    v += kRow;
    if (row.label != kNotObserved) canvas.box(kLeft, v, 16, 14, region_colour(row.label));
    canvas.text(kLeft + kIndent, v, row.words, kWhite);
  }
}

}  // namespace

Snapshots::Snapshots(const Intrinsics& camera, std::size_t model_points, double spacing,
                     std::span<const std::int64_t> frames)
    : camera_(camera), spacing_(spacing) {
  for (const std::int64_t frame : frames) {
    Shot& shot = shots_.emplace_back();
    shot.wanted = frame;
    shot.depth.resize(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
    shot.positions.resize(model_points);
    shot.labels.resize(model_points);
  }
}

void Snapshots::look(const DepthFrame& frame, const TrackResult& result) {
  if (next_ == shots_.size() || frame.number < shots_[next_].wanted) return;
  Shot& shot = shots_[next_++];
  shot.frame = frame.number;
  shot.state = result.state;
  shot.pose = result.pose;
  const auto width = static_cast<std::size_t>(frame.width);
  for (std::size_t v = 0; v < static_cast<std::size_t>(frame.height); ++v)
    std::memcpy(shot.depth.data() + v * width, frame.depth + v * static_cast<std::size_t>(frame.stride),
                width * sizeof(std::uint16_t));
  if (result.state != TrackState::tracking) return;
  std::copy(result.positions.begin(), result.positions.end(), shot.positions.begin());
  std::copy(result.labels.begin(), result.labels.end(), shot.labels.begin());
}

Result<int> Snapshots::write(const std::string& folder) const {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault)
    return Error{ErrorKind::write, fmt::format("cannot make the folder {}: {}", folder, fault.message())};
  int written = 0;
  for (const Shot& shot : shots_) {
    if (shot.frame < 0) continue;
    if (const Outcome drawn = draw(shot, fmt::format("{}/{:06}.png", folder, shot.frame)); !drawn)
      return drawn.error();
    ++written;
  }
  return written;
}

Outcome Snapshots::draw(const Shot& shot, const std::string& path) const {
  Canvas canvas(camera_.width, camera_.height);
  draw_depth(shot.depth, canvas);
  const std::string title = fmt::format("frame {}: {}", shot.frame, state_word(shot.state));
  if (shot.state != TrackState::tracking) {
    draw_key({}, title, canvas);
    return write_png_rgb8(path, canvas.width(), canvas.height(), canvas.rgb());
  }
  // Rigid regions first, so that the deformed points lie on top of their neighbours.
  for (const bool deformed : {false, true})
    for (std::size_t i = 0; i < shot.labels.size(); ++i) {
      const Point3f& p = shot.positions[i];
      if (shot.labels[i] == kNotObserved || (shot.labels[i] == kDeformed) != deformed || !(p.z > 0)) continue;
      const double z = static_cast<double>(p.z);
      canvas.disc(camera_.fx * static_cast<double>(p.x) / z + camera_.cx,
                  camera_.fy * static_cast<double>(p.y) / z + camera_.cy, 0.35 * spacing_ * camera_.fx / z,
                  region_colour(shot.labels[i]), 0.8);
    }
  draw_key(shot.labels, title, canvas);
  return write_png_rgb8(path, canvas.width(), canvas.height(), canvas.rgb());
}

}  // namespace pliant::demo
