// The views that are kept: to close the drift at the end, to fuse from anew, to find the object again.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/capture/view_alignment.hpp"
#include "core/memory/workspace.hpp"

namespace pliant {

struct Keyframe {
  PosedPicture view;
  std::span<ViewPoint> points;  ///< with room for kViewPoints
  std::size_t point_count = 0;
  std::int64_t frame = 0;  ///< its number
  std::span<std::uint16_t> depth_room;
  std::span<std::uint8_t> facing_room;

  [[nodiscard]] std::span<const ViewPoint> sampled() const noexcept { return points.first(point_count); }
};

class Keyframes {
 public:
  /// A slot holds three eighths of the camera's picture.
  void lay_out(Workspace& workspace, const Intrinsics& camera) noexcept;
  void clear() noexcept { count_ = 0; }

  /// Does a view at `pose` show what no kept one does: from 9° or a tenth of the distance away?
  [[nodiscard]] bool wanted(const RigidTransform& pose) const noexcept;
  /// A slot for it. When all are in use, the one of the two most alike that came later gives way.
  [[nodiscard]] Keyframe& add() noexcept;
  [[nodiscard]] std::span<Keyframe> all() noexcept { return {slots_.data(), count_}; }
  [[nodiscard]] std::span<const Keyframe> all() const noexcept { return {slots_.data(), count_}; }
  [[nodiscard]] std::size_t slot_pixels() const noexcept { return slot_pixels_; }

 private:
  std::array<Keyframe, kMaxKeyframes> slots_;
  std::size_t count_ = 0, slot_pixels_ = 0;
};

/// `window` made smaller about its middle until it holds at most `most` pixels.
[[nodiscard]] Window shrunk(Window window, std::size_t most) noexcept;

}  // namespace pliant
