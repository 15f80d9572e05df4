// The model's points as message bodies, encoded once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/model/model_view.hpp"
#include "drivers/lcm/track_messages.hpp"

namespace pliant {

/// What is announced of a model; borrowed.
struct AnnouncedModel {
  std::uint64_t id = 0;               ///< ModelHeader::checksum
  double spacing = 0;                 ///< mean distance of a point to its nearest other, metres
  std::span<const Point3f> points;    ///< model frame, metres; at least one
  std::span<const Normal16> normals;  ///< one a point
};

class ModelMessages {
 public:
  /// Points of one message: it stays below kMaxMessageBytes.
  static constexpr std::size_t kPointsPerPart = 1700;

  /// `model` is not needed afterwards.
  explicit ModelMessages(const AnnouncedModel& model);
  explicit ModelMessages(const ModelView& model);

  /// At least one.
  [[nodiscard]] std::span<const MessageBody> bodies() const noexcept { return bodies_; }

 private:
  static constexpr std::size_t kHeaderBytes = 52, kPointBytes = 9;
  static_assert(kHeaderBytes + kPointsPerPart * kPointBytes <= kMaxMessageBytes);

  std::vector<std::uint8_t> buffer_;
  std::vector<MessageBody> bodies_;
};

}  // namespace pliant
