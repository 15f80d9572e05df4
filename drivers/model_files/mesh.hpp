// What the steps of model building hand on.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

using Triangle = std::array<std::uint32_t, 3>;

/// Metres, model frame. A cloud when there are no triangles.
struct Mesh {
  std::vector<Vector3> vertices;
  std::vector<Vector3> given_normals;  ///< empty, or one a vertex: unit, or zero where the file has none
  std::vector<Triangle> triangles;     ///< of area > 0, no two of the same vertices
};

/// Points with unit normals.
struct OrientedCloud {
  std::vector<Vector3> points;
  std::vector<Vector3> normals;
};

[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}
/// Twice the area, along the normal that the winding gives.
[[nodiscard]] inline Vector3 area_vector(const Mesh& mesh, const Triangle& t) {
  return cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}
/// `v` of length one, or zero when it has no direction.
[[nodiscard]] inline Vector3 unit_or_zero(const Vector3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 1e-300)) return Vector3::Zero();
  const Vector3 scaled = v / largest;
  return scaled / scaled.norm();
}

}  // namespace pliant
