// The built-in simulated sensor: a deforming object, and the truth about it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "core/geometry/rigid_transform.hpp"
#include "drivers/common/result.hpp"
#include "drivers/depth_source/depth_source.hpp"
#include "drivers/geometry_files/geometry.hpp"

namespace pliant {

/// What is true of the frame last delivered. Camera frame, metres.
struct SimulatedTruth {
  std::int64_t number = -1;                  ///< the frame's; -1 before the first
  std::int64_t utime = 0;                    ///< the frame's
  bool present = false;                      ///< some of the object can be seen
  std::span<const Point3f> vertices;         ///< where every vertex of the mesh is
  std::span<const RigidTransform> parts;     ///< camera <- model of every rigid part, part 0 the base
  std::span<const std::int8_t> vertex_part;  ///< the part a vertex is rigidly tied to, -1 = deforms
  std::span<const std::uint8_t> visible;     ///< 1 where nothing stands before the vertex
};

/// Delivers frames on demand, 30 a second by their stamps, the first at 0; whoever wants real time waits.
/// Same options, same bytes, on every platform. No heap call in next().
class SimulatedSource : public DepthSource {
 public:
  /// The object at rest, model frame, metres, with unit normals.
  [[nodiscard]] virtual const Geometry& mesh() const = 0;
  [[nodiscard]] virtual const SimulatedTruth& truth() const = 0;
};

/// Opens "cushion|figure|box[?key=value&…]", with or without "simulated:" before it; the keys are those of
/// options.hpp: seed, noise=structure|none, frames, width, height, motion=handled|turned|circled|carried.
/// ErrorKind::bad_input names what is unknown or out of range.
[[nodiscard]] Result<std::unique_ptr<SimulatedSource>> open_simulated(std::string_view options);

}  // namespace pliant
