#include "drivers/model_files/spring_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/camera/surface.hpp"
#include "drivers/model_files/body_links.hpp"

namespace pliant {

namespace {

constexpr std::size_t kPointsEach = 24;  // fewer would not tell a patch's turn from noise

/// Where the tracker has the point, which counts in whole units from the model's centre.
Vector3 rest(const NetworkInput& input, std::size_t i) {
  const Point3f& p = input.positions[i];
  const Vector3 at = to_vector(p);
  const Vector3 units = (at - input.centre) * kUnitsPerMetre;
  return input.centre +
         Vector3(std::floor(units.x() + 0.5), std::floor(units.y() + 0.5), std::floor(units.z() + 0.5)) /
             kUnitsPerMetre;
}

RestPlace place_of(const Vector3& p) {
  return {p.x(), p.y(), p.z()};
}

std::span<const std::uint16_t> neighbours_of(const NetworkInput& input, std::size_t i) {
  return input.neighbours.subspan(i * limits::kNeighbours, limits::kNeighbours);
}

std::vector<std::uint8_t> spread_from_seeds(const NetworkInput& input, std::size_t count) {
  constexpr std::uint8_t kNone = 0xFF;
  static_assert(limits::kMaxPatches < kNone);
  std::vector<std::uint8_t> patch_of(input.positions.size(), kNone);
  std::vector<std::size_t> queue;
  for (std::size_t p = 0; p < count; ++p) {
    patch_of[p] = static_cast<std::uint8_t>(p);
    queue.push_back(p);
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::size_t i = queue[head];
    for (const std::uint16_t n : neighbours_of(input, i)) {
      if (n == kNoNeighbour || patch_of[n] != kNone) continue;
      patch_of[n] = patch_of[i];
      queue.push_back(n);
    }
  }
  for (std::uint8_t& p : patch_of)
    if (p == kNone) p = 0;  // not connected to any seed
  return patch_of;
}

/// Sizes, centres and the radius that goes with them.
void measure_patches(const NetworkInput& input, std::size_t count, SpringNetwork& network) {
  std::vector<Vector3> centres(count, Vector3::Zero());
  network.patches.resize(count);
  for (std::size_t i = 0; i < input.positions.size(); ++i) {
    ++network.patches[network.patch_of[i]].points;
    centres[network.patch_of[i]] += rest(input, i);
  }
  for (std::size_t p = 0; p < count; ++p) {
    centres[p] /= network.patches[p].points;
    network.patches[p].centre = place_of(centres[p]);
  }
  double square = 0;
  for (std::size_t i = 0; i < input.positions.size(); ++i)
    square += (rest(input, i) - centres[network.patch_of[i]]).squaredNorm();
  network.patch_radius = std::sqrt(2 * square / static_cast<double>(input.positions.size()));
}

/// Beyond the capacity, those that the fewest edges cross are left out.
std::vector<SurfaceLink> surface_links(const NetworkInput& input, const SpringNetwork& network) {
  std::map<std::pair<std::uint8_t, std::uint8_t>, std::pair<std::uint32_t, Vector3>> borders;
  for (std::size_t i = 0; i < input.positions.size(); ++i)
    for (const std::uint16_t n : neighbours_of(input, i)) {
      if (n == kNoNeighbour || network.patch_of[n] == network.patch_of[i]) continue;
      const auto ends = std::minmax(network.patch_of[i], network.patch_of[n]);
      auto& [edges, sum] = borders.try_emplace(ends, 0, Vector3::Zero()).first->second;
      ++edges;
      sum += 0.5 * (rest(input, i) + rest(input, n));
    }
  std::vector<SurfaceLink> links;
  for (const auto& [ends, border] : borders) {
    const auto& [edges, sum] = border;
    const double apart =
        (to_vector(network.patches[ends.first].centre) - to_vector(network.patches[ends.second].centre))
            .norm();
    // The centres of a ring and of the disc within it coincide.
    links.push_back(
        {ends.first, ends.second, 0, edges, place_of(sum / edges), std::max(apart, input.spacing)});
  }
  keep_strongest(links, limits::kMaxBorders, &SurfaceLink::edges);
  return links;
}

/// Weights fall with the distance to a patch's centre, to nothing at two patch radii. `beside`: its
/// neighbours, ascending.
PointBlend blend_of(const NetworkInput& input, const SpringNetwork& network,
                    std::span<const std::uint8_t> beside, std::size_t i) {
  const std::uint8_t own = network.patch_of[i];
  std::array<double, 4> weight{};
  PointBlend out;
  out.patch.fill(own);
  const Vector3 at = rest(input, i);
  for (const std::uint8_t p : beside) {
    const double square = (at - to_vector(network.patches[p].centre)).squaredNorm() /
                          (4 * network.patch_radius * network.patch_radius);
    double w = square < 1 ? (1 - square) * (1 - square) : 0;
    if (p == own) w += 1e-3;
    std::size_t place = 4;
    while (place > 0 && weight[place - 1] < w) --place;
    if (place == 4) continue;
    for (std::size_t j = 3; j > place; --j) {
      weight[j] = weight[j - 1];
      out.patch[j] = out.patch[j - 1];
    }
    weight[place] = w;
    out.patch[place] = p;
  }
  const double sum = weight[0] + weight[1] + weight[2] + weight[3];
  int left = 1 << PointBlend::kShift;
  for (std::size_t j = 3; j > 0; --j) {
    out.weight[j] = static_cast<std::uint8_t>(std::floor(weight[j] / sum * (1 << PointBlend::kShift) + 0.5));
    left -= out.weight[j];
  }
  out.weight[0] = static_cast<std::uint8_t>(left);
  return out;
}

}  // namespace

SpringNetwork spring_network(const NetworkInput& input) {
  const std::size_t points = input.positions.size();
  const std::size_t count = std::min(limits::kMaxPatches, std::max<std::size_t>(1, points / kPointsEach));
  SpringNetwork network;
  network.patch_of = spread_from_seeds(input, count);
  measure_patches(input, count, network);
  network.surface_links = surface_links(input, network);
  std::vector<std::vector<std::uint8_t>> beside(count);  // itself among them
  for (std::size_t p = 0; p < count; ++p) beside[p].push_back(static_cast<std::uint8_t>(p));
  for (const SurfaceLink& link : network.surface_links) {
    beside[link.a].push_back(link.b);
    beside[link.b].push_back(link.a);
  }
  for (std::vector<std::uint8_t>& patches : beside) std::sort(patches.begin(), patches.end());
  for (std::size_t i = 0; i < points; ++i)
    network.blends.push_back(blend_of(input, network, beside[network.patch_of[i]], i));
  if (input.volume) network.body_links = body_links(input, network.patch_of, count);
  return network;
}

}  // namespace pliant
