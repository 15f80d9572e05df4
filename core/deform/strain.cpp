#include "core/deform/strain.hpp"

#include <cmath>

namespace pliant {

Strain measure_strain(const PatchTables& patches, const PatchWarp& warp, double material) noexcept {
  const double limit = strain_limit(material), turn_limit = bend_limit(material);
  Strain out;
  double edges = 0;
  std::array<double, kMaxPatches> squares{};
  std::array<int, kMaxPatches> counts{};
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    if (!(border.length > 0)) continue;
    const RigidTransform &a = warp.pose[border.a], &b = warp.pose[border.b];
    const double now = (a * patches.centres[border.a] - b * patches.centres[border.b]).norm();
    const double change = now / border.length - 1;
    for (const std::uint8_t p : {border.a, border.b}) {
      squares[p] += change * change;
      ++counts[p];
    }
    if (warp.home[border.a] != warp.home[border.b]) continue;
    const double give = limit * border.length;
    const double stretch = (a * border.centre - b * border.centre).squaredNorm() / (give * give);
    const double bend = turn_between(a.rotation, b.rotation).squaredNorm() / (turn_limit * turn_limit);
    out.energy += border.edges * (stretch + bend);
    if (stretch > 1) out.overstrained += border.edges;
    edges += border.edges;
  }
  if (edges > 0) {
    out.energy /= edges;
    out.overstrained /= edges;
  }
  for (std::size_t p = 0; p < patches.count; ++p)
    if (counts[p] > 0) out.patch[p] = static_cast<float>(std::sqrt(squares[p] / counts[p]));
  return out;
}

float strain_at(const PatchTables& patches, const Strain& strain, std::size_t i) noexcept {
  const PointBlend& blend = patches.blend[i];
  float sum = 0;
  for (std::size_t j = 0; j < blend.patch.size(); ++j)
    sum += static_cast<float>(blend.weight[j]) * strain.patch[blend.patch[j]];
  return sum / static_cast<float>(1 << PointBlend::kShift);
}

}  // namespace pliant
