// The springs of a model: the surface in patches, and what holds them together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/model/model_view.hpp"

namespace pliant {

/// What the network is made of; points in the model's order.
struct NetworkInput {
  std::span<const Point3f> positions;
  std::span<const Normal16> normals;
  std::span<const std::uint16_t> neighbours;  ///< limits::kNeighbours a point
  double spacing = 0;                         ///< mean distance of a point to its nearest other, metres
  Vector3 centre = Vector3::Zero();           ///< of the model, metres
  bool volume = false;                        ///< the surface encloses a body: links across it
};

struct SpringNetwork {
  double patch_radius = 0;  ///< of the disc as wide as a patch, metres
  std::vector<std::uint8_t> patch_of;
  std::vector<PointBlend> blends;
  std::vector<ModelPatch> patches;
  std::vector<SurfaceLink> surface_links;
  std::vector<BodyLink> body_links;
};

/// Leaves the `most` links with the highest `strength` out of those in order of the patches that they join,
/// in that order; of equals the first.
template <typename Link>
void keep_strongest(std::vector<Link>& links, std::size_t most, std::uint32_t Link::*strength) {
  if (links.size() <= most) return;
  std::stable_sort(links.begin(), links.end(),
                   [&](const Link& x, const Link& y) { return x.*strength > y.*strength; });
  links.resize(most);
  std::sort(links.begin(), links.end(),
            [](const Link& x, const Link& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
}

/// Every point belongs to the patch of the seed that is nearest along the neighbour graph; the seeds are the
/// first points of the model, a uniform sampling.
[[nodiscard]] SpringNetwork spring_network(const NetworkInput& input);

}  // namespace pliant
