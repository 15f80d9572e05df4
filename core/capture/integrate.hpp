// Fuses views into the volume.
#pragma once

#include <cstdint>
#include <span>

#include "core/capture/distance_volume.hpp"
#include "core/capture/view_picture.hpp"
#include "core/memory/workspace.hpp"
#include "core/track/model_tables.hpp"

namespace pliant {

/// A view to be fused.
struct ViewToFuse {
  const ViewPicture& picture;
  const RigidTransform& pose;  ///< camera <- model, within 2 m
  /// One of many views, as a camera brings them: blocks that it sees through are updated in one of four such
  /// views with four times the weight, and blocks that were fused often in one of three.
  bool one_of_many = false;
};

/// Each node of the active blocks takes the distance of the reading on its line of sight, measured along that
/// reading's normal, into its running mean; readings seen straight on weigh up to sixteen times one seen
/// flat. Nodes and whole blocks that the camera sees through are noted as free, with the least weight.
/// Integers only; lines of sight are exact to 1/20 pixel.
class ViewFuser {
 public:
  void lay_out(Workspace& workspace, const Intrinsics& camera) noexcept;
  void start(const Projector& projector) noexcept { projector_ = &projector; }

  /// `rays` tells where the pixels look.
  void fuse(const ViewToFuse& view, const Surface& rays, DistanceVolume& volume) noexcept;

  /// A node's weight ends here: some hundred straight views. Later ones then count as a moving mean.
  static constexpr std::int32_t kMostWeight = 2000;

 private:
  /// What a tile of 8×8 pixels shows, 1/16 mm; nothing: nearest above farthest.
  struct Tile {
    std::int32_t nearest = 0, farthest = 0;
    bool object = false;
  };
  enum class Sight : std::uint8_t { skip, free, fuse };

  void summarise(const ViewPicture& picture) noexcept;
  /// What the picture has to say of a block whose nodes lie within `radius` of `centre` (camera frame).
  [[nodiscard]] Sight look(const ViewPicture& picture, const IntPoint& centre, std::int32_t radius,
                           const VolumePlan& plan) const noexcept;

  const Projector* projector_ = nullptr;
  std::span<Tile> tiles_;
  int across_ = 0;
  int views_ = 0;
};

}  // namespace pliant
