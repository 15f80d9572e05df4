#include "drivers/model_files/surface_sampling.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/model_files/mesh_normals.hpp"

namespace pliant {

namespace {

/// The farthest that a point of the triangle can be from its nearest corner: the circumradius, or for an
/// obtuse triangle (a little more than it need be) half the longest side.
double covering_radius(const Mesh& mesh, const Triangle& t) {
  double squares[3];
  for (std::size_t k = 0; k < 3; ++k)
    squares[k] = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).squaredNorm();
  const double longest = std::max({squares[0], squares[1], squares[2]});
  if (2 * longest >= squares[0] + squares[1] + squares[2]) return 0.5 * std::sqrt(longest);
  const double twice_area = area_vector(mesh, t).norm();
  return std::sqrt(squares[0] * squares[1]) * std::sqrt(squares[2]) / (2 * twice_area);
}

}  // namespace

double surface_area(const Mesh& mesh) {
  double twice = 0;
  for (const Triangle& t : mesh.triangles) twice += area_vector(mesh, t).norm();
  return 0.5 * twice;
}

double even_spacing(double area, double count) {
  return std::sqrt(2 * area / (std::sqrt(3.0) * count));
}

double even_count(double area, double spacing) {
  return 2 * area / (std::sqrt(3.0) * spacing * spacing);
}

bool vertices_are_dense(const Mesh& mesh, double spacing) {
  double dense = 0, all = 0;
  for (const Triangle& t : mesh.triangles) {
    const double area = area_vector(mesh, t).norm();
    all += area;
    if (covering_radius(mesh, t) <= spacing) dense += area;
  }
  return dense >= 0.95 * all;
}

OrientedCloud sample_surface(const Mesh& mesh, std::size_t count) {
  constexpr double kFirst = 0.7548776662466927,
                   kSecond = 0.5698402909980532;  // 1/g, 1/g² of the plastic number
  const std::vector<std::array<Vector3, 3>> normals = corner_normals(mesh);
  std::vector<double> reached(mesh.triangles.size());
  double area = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    area += area_vector(mesh, mesh.triangles[i]).norm();
    reached[i] = area;
  }
  OrientedCloud cloud;
  cloud.points.reserve(count);
  cloud.normals.reserve(count);
  std::size_t i = 0;
  double first = 0.5, second = 0.5;
  for (std::size_t n = 0; n < count; ++n) {
    const double wanted = area * (static_cast<double>(n) + 0.5) / static_cast<double>(count);
    while (i + 1 < reached.size() && reached[i] < wanted) ++i;
    first += kFirst;
    if (first >= 1) first -= 1;
    second += kSecond;
    if (second >= 1) second -= 1;
    const bool fold = first + second > 1;
    const double v = fold ? 1 - first : first, w = fold ? 1 - second : second, u = 1 - v - w;
    const Triangle& t = mesh.triangles[i];
    cloud.points.emplace_back(u * mesh.vertices[t[0]] + v * mesh.vertices[t[1]] + w * mesh.vertices[t[2]]);
    const Vector3 normal = unit_or_zero(u * normals[i][0] + v * normals[i][1] + w * normals[i][2]);
    cloud.normals.push_back(normal.isZero() ? unit_or_zero(area_vector(mesh, t)) : normal);
  }
  return cloud;
}

}  // namespace pliant
