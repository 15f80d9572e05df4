// The springs of the model as they stand in its image: the surface in patches, links between neighbouring
// patches along the surface, and links across the body between patches on its opposite sides.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/rigid_transform.hpp"
#include "core/limits.hpp"

namespace pliant {

/// Three coordinates, metres, model frame.
using RestPlace = std::array<double, 3>;
[[nodiscard]] inline Vector3 to_vector(const RestPlace& p) noexcept {
  return {p[0], p[1], p[2]};
}

/// A piece of the surface that moves as one.
struct ModelPatch {
  RestPlace centre{};        ///< mean of its points
  std::uint32_t points = 0;  ///< that belong to it, 1 or more
  std::uint32_t pad = 0;
};

/// Two patches that meet along the surface. Stretching is stiff, bending is soft.
struct SurfaceLink {
  std::uint8_t a = 0, b = 0;  ///< a < b
  std::uint16_t pad = 0;
  std::uint32_t edges = 0;  ///< of the neighbour graph that cross the border, 1 or more
  RestPlace centre{};       ///< of the border
  double length = 0;        ///< at rest, from one patch's centre to the other's, metres
};

/// Two patches with the body between them.
struct BodyLink {
  std::uint8_t a = 0, b = 0;  ///< a < b
  std::uint16_t pad = 0;
  std::uint32_t looks = 0;  ///< of eight from each patch into the body, those that met the other, 1 or more
  RestPlace middle{};       ///< between its ends, which are the middles of what faces each other
  double length = 0;        ///< at rest, from one end to the other, metres
};

/// The patches that a point moves with when the surface bends.
struct PointBlend {
  static constexpr int kShift = 7;
  std::array<std::uint8_t, 4> patch{};
  std::array<std::uint8_t, 4> weight{};  ///< Q7, sum 128; what follows a 0 counts for nothing
};

static_assert(sizeof(ModelPatch) == 32 && sizeof(SurfaceLink) == 40 && sizeof(BodyLink) == 40 &&
              sizeof(PointBlend) == 8);

}  // namespace pliant
