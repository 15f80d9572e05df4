#include "core/track/contour.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/track/shadow.hpp"

namespace pliant {

namespace {

/// So many pixels without a reading may be a hole; more are the sensor's shadow, behind the object's edge.
constexpr int kHole = 4;
/// Towards the camera the object may be this many times deeper than the search reaches: it bulges there.
constexpr std::int32_t kBulge = 3;

/// At 0.4 m, a sensor's near limit, what a hand moves in a frame.
constexpr int kMostSteps = 40;

enum class Seen : std::uint8_t { object, other, nothing, hidden };

}  // namespace

bool find_contour(const Surface& surface, const Projector& projector, const ContourReach& reach,
                  const IntPoint& point, const IntPoint& normal, std::int32_t& distance) noexcept {
  int u = 0, v = 0;
  if (!projector.project(point, u, v)) return false;
  // The normal as the picture shows it, the larger component one pixel a step. Bounds: Q14 times 2 at most.
  const std::int32_t across = normal.x - static_cast<std::int32_t>(static_cast<std::int64_t>(normal.z) *
                                                                   point.x / point.z),
                     along = normal.y - static_cast<std::int32_t>(static_cast<std::int64_t>(normal.z) *
                                                                  point.y / point.z);
  const std::int32_t major = std::max(std::abs(across), std::abs(along));
  if (major < 4096) return false;  // towards the camera: no outline
  const std::int32_t step_u = across * 256 / major, step_v = along * 256 / major;
  const auto see = [&](int k) {
    const int at_u = u + ((k * step_u + 128) >> 8), at_v = v + ((k * step_v + 128) >> 8);
    if (!surface.inside(at_u, at_v)) return Seen::hidden;
    const std::uint16_t z8 = surface.depth_at(at_u, at_v);
    if (z8 == 0) return Seen::nothing;
    const std::int32_t gap = 2 * z8 - point.z;
    return gap > reach.behind ? Seen::other : -gap > kBulge * reach.behind ? Seen::hidden : Seen::object;
  };
  const auto shaded = [&](int k) {
    return in_shadow(surface, u + ((k * step_u + 128) >> 8), v + ((k * step_v + 128) >> 8), point.z,
                     kBulge * reach.behind, 1);
  };
  // A step along the larger component is one pixel of it: along the normal, a length of 16384 / major pixels
  // of depth over focal length.
  const int most = std::clamp(projector.pixels(reach.along, point.z) * (major >> 4) >> 10, 2, kMostSteps);
  const Seen here = see(0);
  if (here == Seen::hidden) return false;
  bool any = here == Seen::object;
  int last = 0;
  for (int k = 1; here != Seen::other; ++k) {
    const Seen next = see(k);
    if (next == Seen::hidden || (next == Seen::object && k >= most)) return false;
    if (next == Seen::object) {
      last = k;
      any = true;
    } else if (next == Seen::other) {
      break;
    } else if (k - last > kHole) {
      if (shaded(last + 1)) return false;
      break;
    }
  }
  for (int k = -1; !any; --k) {
    const Seen next = see(k);
    if (next == Seen::hidden || k < -most) return false;
    any = next == Seen::object;
    last = k;
  }
  // half a step beyond the last reading
  distance = static_cast<std::int32_t>(projector.length((2 * last + 1) * 128, point.z) * 16384 / major);
  return std::abs(distance) <= reach.along;
}

}  // namespace pliant
