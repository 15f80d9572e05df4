#include "drivers/model_files/mesh_normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pliant {

namespace {

constexpr double kCreaseCosine = 0.766;  // of 40°

/// The angle whose cosine is x, radians, within 7e-5 (Abramowitz, Stegun: Handbook of Mathematical Functions,
/// 4.4.45): the same bits on every platform.
double angle_of_cosine(double x) {
  const double a = std::min(std::fabs(x), 1.0);
  const double angle = std::sqrt(1 - a) * (1.5707288 + a * (-0.2121144 + a * (0.0742610 - 0.0187293 * a)));
  return x < 0 ? 3.14159265358979 - angle : angle;
}

double angle_at(const Mesh& mesh, const Triangle& t, std::size_t k) {
  const Vector3& p = mesh.vertices[t[k]];
  const Vector3 a = unit_or_zero(mesh.vertices[t[(k + 1) % 3]] - p);
  const Vector3 b = unit_or_zero(mesh.vertices[t[(k + 2) % 3]] - p);
  return angle_of_cosine(a.dot(b));
}

std::vector<Vector3> face_normals(const Mesh& mesh) {
  std::vector<Vector3> normals;
  normals.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) normals.push_back(unit_or_zero(area_vector(mesh, t)));
  return normals;
}

}  // namespace

std::vector<Vector3> vertex_normals(const Mesh& mesh) {
  const std::vector<Vector3> faces = face_normals(mesh);
  std::vector<Vector3> normals(mesh.vertices.size(), Vector3::Zero());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      normals[mesh.triangles[i][k]] += angle_at(mesh, mesh.triangles[i], k) * faces[i];
  for (Vector3& normal : normals) normal = normal.norm() > 1e-6 ? unit_or_zero(normal) : Vector3::Zero();
  return normals;
}

std::vector<std::array<Vector3, 3>> corner_normals(const Mesh& mesh) {
  const std::vector<Vector3> faces = face_normals(mesh);
  // The corners of each vertex, one after the other: corner 3·triangle + k.
  std::vector<std::uint32_t> start(mesh.vertices.size() + 1, 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++start[v + 1];
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<std::uint32_t> corners(3 * mesh.triangles.size());
  std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) corners[fill[mesh.triangles[i][k]]++] = 3 * i + k;

  // A vertex where very many triangles meet (the tip of a finely cut cone) is looked at in part only.
  constexpr std::uint32_t kMostAround = 256;
  std::vector<std::array<Vector3, 3>> normals(mesh.triangles.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[i][k];
      Vector3 sum = angle_at(mesh, mesh.triangles[i], k) * faces[i];
      const std::uint32_t end = std::min(start[v + 1], start[v] + kMostAround);
      for (std::uint32_t c = start[v]; c < end; ++c) {
        const std::uint32_t other = corners[c] / 3;
        if (other != i && faces[other].dot(faces[i]) > kCreaseCosine)
          sum += angle_at(mesh, mesh.triangles[other], corners[c] % 3) * faces[other];
      }
      normals[i][k] = unit_or_zero(sum);
    }
  return normals;
}

}  // namespace pliant
