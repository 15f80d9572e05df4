#include "core/capture/keyframes.hpp"

#include <algorithm>

namespace pliant {

namespace {

constexpr double kCosApart = 0.98769;  // cos 9°
constexpr double kNearerOrFarther = 0.15;

/// Larger is more alike: the cosine of the turn between two views of the object.
double likeness(const RigidTransform& a, const RigidTransform& b) noexcept {
  return cos_angle(a.rotation.transpose() * b.rotation);
}

}  // namespace

void Keyframes::lay_out(Workspace& workspace, const Intrinsics& camera) noexcept {
  slot_pixels_ = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height) * 3 / 8;
  for (Keyframe& slot : slots_) {
    slot.depth_room = workspace.take<std::uint16_t>(slot_pixels_);
    slot.facing_room = workspace.take<std::uint8_t>(slot_pixels_);
    slot.points = workspace.take<ViewPoint>(kViewPoints);
  }
}

bool Keyframes::wanted(const RigidTransform& pose) const noexcept {
  const double distance = pose.translation.norm();
  return std::none_of(
      slots_.begin(), slots_.begin() + static_cast<std::ptrdiff_t>(count_), [&](const Keyframe& kept) {
        const double other = kept.view.pose.translation.norm();
        const bool as_far =
            distance > other * (1 - kNearerOrFarther) && distance < other * (1 + kNearerOrFarther);
        return as_far && likeness(kept.view.pose, pose) > kCosApart;
      });
}

Keyframe& Keyframes::add() noexcept {
  if (count_ < slots_.size()) return slots_[count_++];
  std::size_t victim = count_ - 1;
  double most = -2;
  for (std::size_t i = 0; i < count_; ++i)
    for (std::size_t j = i + 1; j < count_; ++j)
      if (const double alike = likeness(slots_[i].view.pose, slots_[j].view.pose); alike > most) {
        most = alike;
        victim = j;
      }
  // The order of coming is kept: the newest stands last.
  const Keyframe freed = slots_[victim];
  for (std::size_t i = victim + 1; i < count_; ++i) slots_[i - 1] = slots_[i];
  slots_[count_ - 1] = freed;
  return slots_[count_ - 1];
}

Window shrunk(Window w, std::size_t most) noexcept {
  while (!w.empty() && static_cast<std::size_t>(w.u1 - w.u0) * static_cast<std::size_t>(w.v1 - w.v0) > most) {
    if (w.u1 - w.u0 > w.v1 - w.v0) {
      ++w.u0;
      --w.u1;
    } else {
      ++w.v0;
      --w.v1;
    }
  }
  return w;
}

}  // namespace pliant
