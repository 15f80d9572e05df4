#include "drivers/lcm/depth_assembler.hpp"

#include <algorithm>

namespace pliant {

DepthAssembler::DepthAssembler(const Intrinsics& camera)
    : camera_(camera),
      pixels_(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height)),
      row_seen_(static_cast<std::size_t>(camera.height)) {}

bool DepthAssembler::fits(const DepthMessage& message) const noexcept {
  return message.camera.width == camera_.width && message.camera.height == camera_.height &&
         message.camera.depth_scale == camera_.depth_scale;
}

bool DepthAssembler::begins_another(const DepthMessage& message) const noexcept {
  return begun_ && (message.utime != utime_ || message.frame != frame_);
}

bool DepthAssembler::take(const DepthMessage& message) {
  if (!fits(message)) return false;
  if (!begun_ || begins_another(message)) {
    begun_ = true;
    utime_ = message.utime;
    frame_ = message.frame;
    rows_missing_ = camera_.height;
    std::fill(row_seen_.begin(), row_seen_.end(), std::uint8_t{0});
  }
  // A decoded message holds whole rows inside its picture.
  const auto width = static_cast<std::size_t>(camera_.width);
  const auto first = static_cast<std::size_t>(message.first_row);
  std::copy(message.depth.begin(), message.depth.end(),
            pixels_.begin() + static_cast<std::ptrdiff_t>(first * width));
  for (std::size_t v = first; v < first + message.depth.size() / width; ++v) {
    if (row_seen_[v] == 0) --rows_missing_;
    row_seen_[v] = 1;
  }
  if (rows_missing_ > 0) return false;
  begun_ = false;
  return true;
}

DepthFrame DepthAssembler::frame() const noexcept {
  return {pixels_.data(), camera_.width, camera_.height, camera_.width, utime_, frame_};
}

}  // namespace pliant
