#include "firmware-app/demo/snapshots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "drivers/images/png.hpp"
#include "firmware-app/outputs/run_report.hpp"
#include "firmware-app/pictures/scene_picture.hpp"

namespace pliant::demo {

Snapshots::Snapshots(const Intrinsics& camera, const ModelView& model, std::span<const std::int64_t> frames)
    : camera_(camera), model_(model) {
  for (const std::int64_t frame : frames) {
    Shot& shot = shots_.emplace_back();
    shot.wanted = frame;
    shot.depth.resize(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
    shot.positions.resize(model.size());
    shot.labels.resize(model.size());
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
  SceneView view;
  view.camera = camera_;
  view.depth = shot.depth;
  view.title = fmt::format("frame {}: {}", shot.frame, state_word(shot.state));
  std::vector<float> displacement(shot.positions.size());
  if (shot.state == TrackState::tracking) {
    for (std::size_t i = 0; i < displacement.size(); ++i) {
      if (shot.labels[i] != kDeformed) continue;
      const Vector3 carried = shot.pose * to_vector(model_.positions()[i]);
      displacement[i] = static_cast<float>((to_vector(shot.positions[i]) - carried).norm());
    }
    view.positions = shot.positions;
    view.labels = shot.labels;
    view.displacement = displacement;
    view.axes = {&shot.pose, 1};
    view.spacing = model_.spacing();
  }
  const Canvas canvas = draw_scene(view);
  return write_png_rgb8(path, canvas.width(), canvas.height(), canvas.rgb());
}

}  // namespace pliant::demo
