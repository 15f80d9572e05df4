#include "drivers/lcm/depth_messages.hpp"

#include "core/limits.hpp"
#include "drivers/lcm/fingerprint.hpp"
#include "drivers/lcm/wire.hpp"

namespace pliant {

DepthMessages::DepthMessages(int width, int height)
    : width_(std::clamp(width, 1, limits::kMaxFrameWidth)),
      height_(std::clamp(height, 1, limits::kMaxFrameHeight)) {
  const auto rows = static_cast<std::size_t>(rows_per_part(width_));
  const auto all_rows = static_cast<std::size_t>(height_);
  bodies_.resize((all_rows + rows - 1) / rows);
  buffer_.resize(bodies_.size() * kHeaderBytes +
                 all_rows * sizeof(std::uint16_t) * static_cast<std::size_t>(width_));
}

std::span<const MessageBody> DepthMessages::encode(const DepthFrame& frame,
                                                   const Intrinsics& camera) noexcept {
  if (frame.depth == nullptr || frame.width < 1 || frame.height < 1 || frame.width > width_ ||
      frame.height > height_) {
    return {};
  }
  const int rows = rows_per_part(width_);
  const int parts = (frame.height + rows - 1) / rows;
  std::size_t used = 0;
  for (int part = 0; part < parts; ++part) {
    const int first = part * rows;
    const int end = std::min(first + rows, frame.height);
    wire::Writer out(std::span<std::uint8_t>(buffer_).subspan(used));
    out.put<std::uint64_t>(wire::kDepthFingerprint);
    out.put<std::int64_t>(frame.utime);
    out.put<std::int64_t>(frame.number);
    out.put<std::int16_t>(static_cast<std::int16_t>(part));
    out.put<std::int16_t>(static_cast<std::int16_t>(parts));
    out.put<std::int32_t>(frame.width);
    out.put<std::int32_t>(frame.height);
    for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy, camera.depth_scale}) {
      out.put<double>(value);
    }
    out.put<std::int32_t>(first);
    out.put<std::int32_t>(end - first);
    out.put<std::int32_t>(2 * frame.width * (end - first));
    for (int v = first; v < end; ++v) {
      const std::uint16_t* const row = frame.depth + std::ptrdiff_t{v} * frame.stride;
      out.put_little_endian({row, static_cast<std::size_t>(frame.width)});
    }
    bodies_[static_cast<std::size_t>(part)] = {
        MessageKind::depth, std::span<const std::uint8_t>(buffer_).subspan(used, out.size())};
    used += out.size();
  }
  return std::span<const MessageBody>(bodies_).first(static_cast<std::size_t>(parts));
}

}  // namespace pliant
