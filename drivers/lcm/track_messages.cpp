#include "drivers/lcm/track_messages.hpp"

#include <algorithm>

#include "drivers/lcm/fingerprint.hpp"
#include "drivers/lcm/wire.hpp"

namespace pliant {

namespace {

void put_transform(wire::Writer& out, const RigidTransform& transform) noexcept {
  for (int i = 0; i < 3; ++i) out.put<double>(transform.translation[i]);
  const Quaternion q = quaternion_from_rotation(transform.rotation);
  for (const double value : {q.w, q.x, q.y, q.z}) out.put<double>(value);
}

void put_point(wire::Writer& out, const Point3f& point) noexcept {
  out.put<float>(point.x);
  out.put<float>(point.y);
  out.put<float>(point.z);
}

}  // namespace

TrackMessages::TrackMessages(std::span<const Point3f> rest, std::uint64_t model_id)
    : rest_(rest.first(std::min(rest.size(), limits::kMaxModelPoints))),
      model_id_(model_id),
      buffer_(max_bytes(rest_.size())),
      bodies_(max_bodies(rest_.size())),
      deformed_(rest_.size()),
      displacements_(rest_.size()) {}

std::span<const MessageBody> TrackMessages::encode(const TrackResult& result, float trust) noexcept {
  used_bytes_ = 0;
  used_bodies_ = 0;
  if (!result.frame_used) return {};
  const bool tracking = result.state == TrackState::tracking;
  // The pose of a base that is out of sight is carried along, not measured: it is not announced as new.
  const bool base_seen = tracking && !result.regions.empty() && result.regions.front().id == 0;
  if (base_seen) add_pose(result);
  add_regions(result, trust);
  if (tracking) add_deformed(result);
  return std::span<const MessageBody>(bodies_).first(used_bodies_);
}

std::span<std::uint8_t> TrackMessages::free_bytes() noexcept {
  return std::span<std::uint8_t>(buffer_).subspan(used_bytes_);
}

void TrackMessages::add_body(MessageKind kind, std::size_t bytes) noexcept {
  bodies_[used_bodies_++] = {kind, std::span<const std::uint8_t>(buffer_).subspan(used_bytes_, bytes)};
  used_bytes_ += bytes;
}

void TrackMessages::add_pose(const TrackResult& result) noexcept {
  wire::Writer out(free_bytes());
  out.put<std::uint64_t>(wire::kPoseFingerprint);
  out.put<std::int64_t>(result.utime);
  put_transform(out, result.pose);
  add_body(MessageKind::pose, out.size());
}

void TrackMessages::add_regions(const TrackResult& result, float trust) noexcept {
  const bool tracking = result.state == TrackState::tracking;
  const std::span<const Region> no_regions;
  const auto regions =
      tracking ? result.regions.first(std::min(result.regions.size(), std::size_t{limits::kMaxRegions}))
               : no_regions;
  const std::size_t labels = tracking ? std::min(result.labels.size(), rest_.size()) : 0;
  const std::size_t part_count = parts(labels, kLabelsPerPart);
  for (std::size_t part = 0; part < part_count; ++part) {
    const std::size_t first = part * kLabelsPerPart;
    const std::size_t count = std::min(labels - first, kLabelsPerPart);
    wire::Writer out(free_bytes());
    out.put<std::uint64_t>(wire::kRegionsFingerprint);
    out.put<std::int64_t>(result.utime);
    out.put<std::int64_t>(result.frame);
    out.put<std::uint64_t>(model_id_);
    out.put<std::int8_t>(static_cast<std::int8_t>(result.state));
    out.put<float>(tracking ? trust * result.confidence : 0.0F);
    out.put<std::int16_t>(static_cast<std::int16_t>(part));
    out.put<std::int16_t>(static_cast<std::int16_t>(part_count));
    out.put<std::int32_t>(static_cast<std::int32_t>(regions.size()));
    for (const Region& region : regions) {
      out.put<std::int8_t>(region.id);
      out.put<std::int8_t>(region.parent);
      out.put<std::int32_t>(static_cast<std::int32_t>(region.points));
      out.put<float>(region.rms);
      out.put<float>(trust * region.confidence);
      put_transform(out, region.pose);
      put_point(out, region.joint);
    }
    out.put<std::int32_t>(static_cast<std::int32_t>(rest_.size()));
    out.put<std::int32_t>(static_cast<std::int32_t>(first));
    out.put<std::int32_t>(static_cast<std::int32_t>(count));
    out.put_bytes(result.labels.subspan(labels == 0 ? 0 : first, count));
    add_body(MessageKind::regions, out.size());
  }
}

void TrackMessages::add_deformed(const TrackResult& result) noexcept {
  const std::size_t points =
      std::min({result.labels.size(), result.positions.size(), result.strains.size(), rest_.size()});
  std::size_t deformed = 0;
  for (std::size_t i = 0; i < points; ++i) {
    if (result.labels[i] != kDeformed) continue;
    const Vector3 carried = result.pose * Vector3(rest_[i].x, rest_[i].y, rest_[i].z);
    const Vector3 now(result.positions[i].x, result.positions[i].y, result.positions[i].z);
    const Vector3 moved = now - carried;
    displacements_[deformed] = to_point(moved);
    deformed_[deformed++] = static_cast<std::uint16_t>(i);
  }
  const std::size_t part_count = parts(deformed, kDeformedPerPart);
  for (std::size_t part = 0; part < part_count; ++part) {
    const std::size_t first = part * kDeformedPerPart;
    const std::size_t end = std::min(deformed, first + kDeformedPerPart);
    wire::Writer out(free_bytes());
    out.put<std::uint64_t>(wire::kDeformedFingerprint);
    out.put<std::int64_t>(result.utime);
    out.put<std::int64_t>(result.frame);
    out.put<std::uint64_t>(model_id_);
    out.put<std::int16_t>(static_cast<std::int16_t>(part));
    out.put<std::int16_t>(static_cast<std::int16_t>(part_count));
    out.put<std::int32_t>(static_cast<std::int32_t>(deformed));
    out.put<std::int32_t>(static_cast<std::int32_t>(end - first));
    for (std::size_t k = first; k < end; ++k) out.put<std::int16_t>(static_cast<std::int16_t>(deformed_[k]));
    for (std::size_t k = first; k < end; ++k) put_point(out, result.positions[deformed_[k]]);
    for (std::size_t k = first; k < end; ++k) put_point(out, displacements_[k]);
    for (std::size_t k = first; k < end; ++k) out.put<float>(result.strains[deformed_[k]]);
    add_body(MessageKind::deformed, out.size());
  }
}

}  // namespace pliant
