#include "core/deform/strain.hpp"

#include <cmath>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

namespace {

double distance(const IntPoint& a, const IntPoint& b) noexcept {
  const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return std::sqrt(x * x + y * y + z * z);
}

IntPoint at_rest(const ModelTables& model, std::size_t i) noexcept {
  return {model.x[i], model.y[i], model.z[i]};
}

}  // namespace

Strain measure_strain(const PatchTables& patches, const PatchWarp& warp, double material) noexcept {
  const double give = strain_limit(material) * patches.pitch(), turn_limit = bend_limit(material);
  double energy = 0, over = 0, edges = 0;
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    if (warp.home[border.a] != warp.home[border.b]) continue;
    const RigidTransform &a = warp.pose[border.a], &b = warp.pose[border.b];
    const double stretch = (a * border.centre - b * border.centre).squaredNorm() / (give * give);
    const double bend = turn_between(a.rotation, b.rotation).squaredNorm() / (turn_limit * turn_limit);
    energy += border.edges * (stretch + bend);
    if (stretch > 1) over += border.edges;
    edges += border.edges;
  }
  return edges > 0 ? Strain{energy / edges, over / edges} : Strain{};
}

float strain_at(const ModelTables& model, const PatchTables& patches, const PatchWarp& warp,
                std::size_t i) noexcept {
  const IntPoint now = warped_point(model, patches, warp, i), rest = at_rest(model, i);
  double sum = 0;
  int edges = 0;
  for (const std::uint16_t n : model.model->neighbours(i)) {
    if (n >= model.size) continue;
    const double length = distance(at_rest(model, n), rest);
    if (!(length > 0)) continue;
    const double change = distance(warped_point(model, patches, warp, n), now) / length - 1;
    sum += change * change;
    ++edges;
  }
  return edges > 0 ? static_cast<float>(std::sqrt(sum / edges)) : 0.0F;
}

bool find_joint(const PatchTables& patches, const PatchWarp& warp, std::int8_t k, std::int8_t parent,
                Vector3& joint) noexcept {
  Vector3 sum = Vector3::Zero();
  double edges = 0;
  for (std::size_t b = 0; b < patches.border_count; ++b) {
    const PatchBorder& border = patches.borders[b];
    const std::int8_t x = warp.home[border.a], y = warp.home[border.b];
    if (!(x == k && y == parent) && !(x == parent && y == k)) continue;
    sum += border.edges * border.centre;
    edges += border.edges;
  }
  if (!(edges > 0)) return false;
  joint = sum / edges;
  return true;
}

}  // namespace pliant
