// One frame's result as message bodies: what is hashed for replay comparison and what is sent. Encoding has
// no clock and no counter: the same results give the same bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/rigid_transform.hpp"
#include "core/limits.hpp"
#include "core/track_result.hpp"
#include "drivers/lcm/messages.hpp"

namespace pliant {

/// One message without its channel. The bytes belong to the encoder.
struct MessageBody {
  MessageKind kind = MessageKind::pose;
  std::span<const std::uint8_t> bytes;
};

/// Encodes into buffers that the constructor allocates and touches; encode() neither allocates nor throws.
class TrackMessages {
 public:
  /// Labels and deformed points of one message; more make further parts. Either way a body stays below
  /// kMaxMessageBytes.
  static constexpr std::size_t kLabelsPerPart = 15000;
  static constexpr std::size_t kDeformedPerPart = 530;

  /// `rest`: the model's points in the model frame, metres, up to limits::kMaxModelPoints (further ones are
  /// left out); must outlive this. `model_id`: ModelHeader::checksum.
  TrackMessages(std::span<const Point3f> rest, std::uint64_t model_id);

  /// The bodies of one frame: pose, the parts of regions, the parts of deformed. Valid until the next call.
  /// Pose only while the base region is seen; deformed only while tracking; none for a frame that was not
  /// used. Every confidence is told times `trust`, [0, 1]: what the state of the stream leaves of it.
  [[nodiscard]] std::span<const MessageBody> encode(const TrackResult& result, float trust = 1) noexcept;

  /// What one frame of a model of `points` points can take at most.
  [[nodiscard]] static constexpr std::size_t max_bodies(std::size_t points) noexcept {
    return 1 + parts(points, kLabelsPerPart) + parts(points, kDeformedPerPart);
  }
  [[nodiscard]] static constexpr std::size_t max_bytes(std::size_t points) noexcept {
    return kPoseBytes + parts(points, kLabelsPerPart) * kRegionsHeaderBytes + points +
           parts(points, kDeformedPerPart) * kDeformedHeaderBytes + points * kDeformedPointBytes;
  }

 private:
  // Sizes on the wire: the fingerprint and the fields of types/*.lcm.
  static constexpr std::size_t kPoseBytes = 72;
  static constexpr std::size_t kRegionBytes = 82;
  static constexpr std::size_t kRegionsHeaderBytes = 57 + limits::kMaxRegions * kRegionBytes;
  static constexpr std::size_t kDeformedHeaderBytes = 44;
  static constexpr std::size_t kDeformedPointBytes = 30;
  static_assert(kRegionsHeaderBytes + kLabelsPerPart <= kMaxMessageBytes);
  static_assert(kDeformedHeaderBytes + kDeformedPerPart * kDeformedPointBytes <= kMaxMessageBytes);
  static_assert(limits::kMaxModelPoints <= 32768, "indices are int16");

  /// At least one: an empty list is a message too.
  static constexpr std::size_t parts(std::size_t count, std::size_t per_part) noexcept {
    return count <= per_part ? 1 : (count + per_part - 1) / per_part;
  }

  void add_pose(const TrackResult& result) noexcept;
  void add_regions(const TrackResult& result, float trust) noexcept;
  void add_deformed(const TrackResult& result) noexcept;
  void add_body(MessageKind kind, std::size_t bytes) noexcept;
  [[nodiscard]] std::span<std::uint8_t> free_bytes() noexcept;

  std::span<const Point3f> rest_;
  std::uint64_t model_id_;
  std::vector<std::uint8_t> buffer_;
  std::vector<MessageBody> bodies_;
  std::vector<std::uint16_t> deformed_;
  std::vector<Point3f> displacements_;
  std::size_t used_bytes_ = 0, used_bodies_ = 0;
};

}  // namespace pliant
