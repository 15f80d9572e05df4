#include "drivers/model_files/body_links.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace pliant {

namespace {

constexpr std::size_t kLooksEach = 8;       // of a patch, on average
constexpr std::uint32_t kFewestOfThem = 2;  // fewer are the fringe of a wider link
/// Cosine of the angle at which a look may leave the body: askew, it says nothing of its thickness.
constexpr double kStraight = 0.5;
/// A surface nearer than this is the one that the look starts from, in spacings.
constexpr double kSameSurface = 2;

/// What lies between two patches.
struct Tally {
  std::uint32_t looks = 0;
  Vector3 at_a = Vector3::Zero(), at_b = Vector3::Zero();  // sums
};

/// The model in double precision.
struct Body {
  std::vector<Vector3> points, normals;
};

Body body_of(const NetworkInput& input) {
  Body body;
  for (std::size_t i = 0; i < input.positions.size(); ++i) {
    const Point3f& p = input.positions[i];
    const Normal16& n = input.normals[i];
    body.points.push_back(to_vector(p));
    body.normals.emplace_back(Vector3(n.x, n.y, n.z) / 16384.0);
  }
  return body;
}

/// The point at which a look from point i straight into the body leaves it; i itself where it leaves askew,
/// or meets a surface that it would have to enter the body by.
std::size_t other_side(const Body& body, std::size_t i, double spacing) {
  const Vector3 into = -body.normals[i];
  std::size_t nearest = i;
  double least = 0, leaving = 0;
  for (std::size_t j = 0; j < body.points.size(); ++j) {
    const Vector3 step = body.points[j] - body.points[i];
    const double along = into.dot(step);
    if (along <= 0 || (nearest != i && along >= least)) continue;
    if (step.squaredNorm() - along * along > spacing * spacing) continue;  // aside
    const double cosine = into.dot(body.normals[j]);
    if (cosine <= 0 && along < kSameSurface * spacing) continue;
    nearest = j;
    least = along;
    leaving = cosine;
  }
  return leaving > kStraight ? nearest : i;
}

}  // namespace

std::vector<BodyLink> body_links(const NetworkInput& input, std::span<const std::uint8_t> patch_of,
                                 std::size_t patches) {
  const Body body = body_of(input);
  // The first points of a model are spread evenly.
  const std::size_t looks = std::min(input.positions.size(), kLooksEach * patches);
  std::map<std::pair<std::uint8_t, std::uint8_t>, Tally> tallies;
  for (std::size_t i = 0; i < looks; ++i) {
    const std::size_t j = other_side(body, i, input.spacing);
    if (patch_of[i] == patch_of[j]) continue;
    const bool from_a = patch_of[i] < patch_of[j];
    Tally& tally = tallies[std::minmax(patch_of[i], patch_of[j])];
    ++tally.looks;
    tally.at_a += body.points[from_a ? i : j];
    tally.at_b += body.points[from_a ? j : i];
  }
  std::vector<BodyLink> links;
  for (const auto& [ends, tally] : tallies) {
    if (tally.looks < kFewestOfThem) continue;
    const Vector3 a = tally.at_a / tally.looks, b = tally.at_b / tally.looks;
    const Vector3 middle = 0.5 * (a + b);
    links.push_back({ends.first,
                     ends.second,
                     0,
                     tally.looks,
                     {middle.x(), middle.y(), middle.z()},
                     std::max((b - a).norm(), input.spacing)});
  }
  keep_strongest(links, limits::kMaxBodyLinks, &BodyLink::looks);
  return links;
}

}  // namespace pliant
