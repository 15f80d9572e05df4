#include "core/track/patches.hpp"

namespace pliant {

void PatchTables::start(const ModelView& model) noexcept {
  count = model.patches().size();
  radius = model.patch_radius();
  patch_of = model.patch_of();
  blend = model.blends();
  for (std::size_t p = 0; p < count; ++p) {
    sizes[p] = model.patches()[p].points;
    centres[p] = to_vector(model.patches()[p].centre);
  }
  neighbours = {};
  border_count = 0;
  for (const SurfaceLink& link : model.surface_links()) {
    borders[border_count++] = {link.a, link.b, link.edges, to_vector(link.centre), link.length};
    neighbours[link.a].add(link.b);
    neighbours[link.b].add(link.a);
  }
  tie_count = 0;
  for (const BodyLink& link : model.body_links())
    ties[tie_count++] = {link.a, link.b, link.looks, to_vector(link.middle), link.length};
}

}  // namespace pliant
