#include "drivers/lcm/frame_assembler.hpp"

#include <algorithm>
#include <array>

namespace pliant {

namespace {

/// Notes a part; false where it was there already, or the parts are not those that came before.
bool note(std::vector<bool>& seen, std::int16_t part, std::int16_t parts) {
  const auto count = static_cast<std::size_t>(parts);
  if (seen.empty()) seen.assign(count, false);
  if (seen.size() != count || seen[static_cast<std::size_t>(part)]) return false;
  seen[static_cast<std::size_t>(part)] = true;
  return true;
}

bool all(const std::vector<bool>& seen) {
  return !seen.empty() && std::find(seen.begin(), seen.end(), false) == seen.end();
}

RigidTransform transform_of(const RegionMessage& region) {
  const auto& [w, x, y, z] = region.quat;
  return {rotation_from_quaternion({w, x, y, z}), Vector3(region.trans[0], region.trans[1], region.trans[2])};
}

}  // namespace

void FrameAssembler::begin(std::int64_t utime, std::int64_t frame, std::int64_t model_id) {
  if (begun_ && frame_.utime == utime && frame_.frame == frame && frame_.model_id == model_id) return;
  if (begun_ && !told_) ++incomplete_;
  begun_ = true;
  told_ = false;
  frame_.utime = utime;
  frame_.frame = frame;
  frame_.model_id = model_id;
  frame_.state = TrackState::searching;
  frame_.regions.clear();
  frame_.labels.clear();
  frame_.deformed.clear();
  frame_.position.clear();
  frame_.displacement.clear();
  frame_.strain.clear();
  deformed_.clear();
  regions_seen_.clear();
  deformed_seen_.clear();
}

/// The deformed points in ascending order, whatever the order of their parts; false where one is told twice.
bool FrameAssembler::order_deformed() {
  std::sort(deformed_.begin(), deformed_.end(),
            [](const DeformedPoint& a, const DeformedPoint& b) { return a.index < b.index; });
  for (std::size_t i = 0; i < deformed_.size(); ++i) {
    const DeformedPoint& point = deformed_[i];
    if (i > 0 && deformed_[i - 1].index == point.index) return false;
    frame_.deformed.push_back(point.index);
    frame_.position.push_back(point.position);
    frame_.displacement.push_back(point.displacement);
    frame_.strain.push_back(point.strain);
  }
  return true;
}

/// True when nothing is missing and nothing contradicts.
bool FrameAssembler::finish() {
  if (!all(regions_seen_) || (frame_.state == TrackState::tracking && !all(deformed_seen_))) return false;
  told_ = true;
  if (order_deformed()) return true;
  ++incomplete_;
  return false;
}

bool FrameAssembler::take(const RegionsMessage& message) {
  begin(message.utime, message.frame, message.model_id);
  if (told_ || !note(regions_seen_, message.part, message.parts)) return false;
  frame_.state = message.state;
  frame_.confidence = message.confidence;
  frame_.regions = message.regions;
  if (message.state == TrackState::tracking) {
    frame_.labels.resize(static_cast<std::size_t>(message.model_points), kNotObserved);
    std::copy(message.labels.begin(), message.labels.end(), frame_.labels.begin() + message.first_point);
  }
  return finish();
}

bool FrameAssembler::take(const DeformedMessage& message) {
  begin(message.utime, message.frame, message.model_id);
  if (told_ || !note(deformed_seen_, message.part, message.parts)) return false;
  for (std::size_t i = 0; i < message.index.size(); ++i)
    deformed_.push_back({message.index[i], message.position[i], message.displacement[i], message.strain[i]});
  return finish();
}

bool ModelAssembler::take(const ModelMessage& message) {
  if (model_.model_id == message.model_id && !model_.points.empty()) return false;
  const auto points = static_cast<std::size_t>(message.model_points);
  if (seen_.empty() || coming_.model_id != message.model_id || coming_.points.size() != points ||
      seen_.size() != static_cast<std::size_t>(message.parts)) {
    seen_.clear();
    coming_ = {message.model_id, message.spacing, std::vector<Point3f>(points), std::vector<Point3f>(points)};
  }
  if (!note(seen_, message.part, message.parts)) return false;
  std::copy(message.position.begin(), message.position.end(), coming_.points.begin() + message.first_point);
  std::copy(message.normal.begin(), message.normal.end(), coming_.normals.begin() + message.first_point);
  if (!all(seen_)) return false;
  model_ = std::move(coming_);
  seen_.clear();
  coming_ = {};
  return true;
}

bool PictureAssembler::take(const DepthMessage& message) {
  const Intrinsics& camera = message.camera;
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (seen_.empty() || picture_.utime != message.utime || picture_.frame != message.frame ||
      picture_.camera.width != camera.width || picture_.depth.size() != pixels ||
      seen_.size() != static_cast<std::size_t>(message.parts)) {
    if (!seen_.empty()) ++incomplete_;
    seen_.clear();
    picture_.utime = message.utime;
    picture_.frame = message.frame;
    picture_.camera = camera;
    picture_.depth.assign(pixels, 0);
  }
  if (!note(seen_, message.part, message.parts)) return false;
  std::copy(message.depth.begin(), message.depth.end(),
            picture_.depth.begin() + std::ptrdiff_t{message.first_row} * camera.width);
  if (!all(seen_)) return false;
  seen_.clear();
  return true;
}

void place_points(const ReceivedFrame& frame, const ReceivedModel& model, std::vector<Point3f>& positions) {
  positions.clear();
  if (frame.state != TrackState::tracking || frame.model_id != model.model_id || frame.regions.empty() ||
      frame.labels.size() != model.points.size())
    return;
  // By label; the first region stands in for labels without a region of their own.
  std::array<const RegionMessage*, 128> by_label{};
  for (const RegionMessage& region : frame.regions) by_label[static_cast<std::size_t>(region.id)] = &region;
  std::array<RigidTransform, 128> transforms;
  const RigidTransform first = transform_of(frame.regions.front());
  for (std::size_t i = 0; i < by_label.size(); ++i)
    transforms[i] = by_label[i] == nullptr ? first : transform_of(*by_label[i]);
  positions.resize(model.points.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::int8_t label = frame.labels[i];
    const Point3f& rest = model.points[i];
    const RigidTransform& motion = label >= 0 ? transforms[static_cast<std::size_t>(label)] : first;
    positions[i] = to_point(motion * to_vector(rest));
  }
  for (std::size_t i = 0; i < frame.deformed.size(); ++i) {
    const auto index = static_cast<std::size_t>(frame.deformed[i]);
    if (index < positions.size()) positions[index] = frame.position[i];
  }
}

}  // namespace pliant
