// The things that move before the simulated camera.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/geometry_files/geometry.hpp"

namespace pliant::simulated {

/// Frames without any motion at the start, and of one round of motion after it. Every round begins and ends
/// in the state at rest.
inline constexpr int kStillFrames = 15;
inline constexpr int kRound = 285;
inline constexpr std::size_t kMaxParts = 4;

/// Where frame `number` stands in the round: 0 while still.
[[nodiscard]] inline double phase_of(std::int64_t number) {
  return number < kStillFrames ? 0 : static_cast<double>((number - kStillFrames) % kRound);
}

/// What an actor is doing at one moment. Table frame: x right, y away from the camera, z up, origin where the
/// camera looks at; metres.
struct ActorState {
  RigidTransform parts[kMaxParts];  ///< table <- model, part 0 the base
  RigidTransform hand;              ///< table <- hand
};

/// The object to be tracked, and a hand that handles it.
class Actor {
 public:
  Actor() = default;
  Actor(const Actor&) = delete;
  Actor& operator=(const Actor&) = delete;
  virtual ~Actor() = default;

  [[nodiscard]] const Geometry& mesh() const { return mesh_; }
  [[nodiscard]] const Geometry& hand() const { return hand_; }
  /// Per vertex the part that it is rigidly tied to, -1 where none.
  [[nodiscard]] std::span<const std::int8_t> vertex_part() const { return vertex_part_; }
  [[nodiscard]] std::size_t parts() const { return parts_; }

  /// The state at `phase` and every vertex of the mesh in the table's frame.
  virtual void move(double phase, ActorState& state, std::span<Vector3> vertices) const = 0;

 protected:
  [[nodiscard]] Vector3 rest(std::size_t i) const {
    const Point3f& p = mesh_.vertices[i];
    return to_vector(p);
  }

  Geometry mesh_;  ///< model frame
  Geometry hand_;
  std::vector<std::int8_t> vertex_part_;
  std::size_t parts_ = 1;
};

/// A pillow with a knob, a ridge, a lump and a groove, 33 cm long, that a fist dents by 35 mm; it slides and
/// turns on the table.
[[nodiscard]] std::unique_ptr<Actor> make_cushion();
/// A standing figure, 38 cm tall, jointed at the waist and at one elbow.
[[nodiscard]] std::unique_ptr<Actor> make_figure();
/// A box with a block on top, a cut corner and a round boss, 24 cm long, that is moved, hidden in part by a
/// hand, carried out of the picture and brought back.
[[nodiscard]] std::unique_ptr<Actor> make_box();

/// A fist with a forearm that reaches up to the right; the origin is its lowest point.
[[nodiscard]] Geometry fist_mesh();
/// An open hand with a forearm that reaches to the right; the origin is the middle of the palm.
[[nodiscard]] Geometry open_hand_mesh();

}  // namespace pliant::simulated
