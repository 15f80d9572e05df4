#include "core/track/contour.hpp"

#include <algorithm>
#include <cstdlib>

namespace pliant {

namespace {

constexpr std::int32_t kCos80 = 2845;  // Q14
/// A single pixel without a reading is a gap, two in a row are the end.
constexpr int kGap = 2;
/// Towards the camera the object may be this many times deeper than the search reaches: it bulges there.
constexpr std::int32_t kBulge = 3;

/// At 0.4 m, a sensor's near limit, what a hand moves in a frame.
constexpr int kMostSteps = 40;

enum class Seen : std::uint8_t { object, other, nearer };

}  // namespace

bool on_rim(const IntPoint& point, const IntPoint& normal) noexcept {
  const std::int32_t towards =
      -(normal.x * (point.x >> 4) + normal.y * (point.y >> 4) + normal.z * (point.z >> 4));
  return std::abs(towards / 16384) <= ((kCos80 * (point.z >> 4)) >> 14);
}

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
    const std::uint16_t z8 = surface.depth(u + ((k * step_u + 128) >> 8), v + ((k * step_v + 128) >> 8));
    if (z8 == 0) return Seen::other;
    const std::int32_t gap = 2 * z8 - point.z;
    return gap > reach.behind ? Seen::other : -gap > kBulge * reach.behind ? Seen::nearer : Seen::object;
  };
  // A step along the larger component is one pixel of it: along the normal, a length of 16384 / major pixels
  // of depth over focal length.
  const int most = std::clamp(projector.pixels(reach.along, point.z) * (major >> 4) >> 10, 2, kMostSteps);
  const Seen here = see(0);
  if (here == Seen::nearer) return false;
  int last = 0;
  if (here == Seen::object) {
    int missing = 0;
    for (int k = 1;; ++k) {
      if (k > most + kGap) return false;
      const Seen next = see(k);
      if (next == Seen::nearer) return false;
      if (next == Seen::object) {
        last = k;
        missing = 0;
      } else if (++missing == kGap) {
        break;
      }
    }
  } else {
    int k = -1;
    for (; k >= -most; --k) {
      const Seen next = see(k);
      if (next == Seen::nearer) return false;
      if (next == Seen::object) break;
    }
    if (k < -most) return false;
    last = k;
  }
  // half a step beyond the last reading
  distance = static_cast<std::int32_t>(projector.length((2 * last + 1) * 128, point.z) * 16384 / major);
  return std::abs(distance) <= reach.along;
}

}  // namespace pliant
