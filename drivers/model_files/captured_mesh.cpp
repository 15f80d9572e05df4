#include "drivers/model_files/captured_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "core/capture/capture_settings.hpp"
#include "core/limits.hpp"
#include "drivers/geometry_files/surface_net.hpp"
#include "drivers/model_files/mesh.hpp"
#include "drivers/model_files/mesh_normals.hpp"
#include "drivers/model_files/mesh_smoothing.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/surface_sampling.hpp"

namespace pliant {

namespace {

/// The largest of the connected parts and those of at least `share` of its area.
void drop_islands(Mesh& mesh, double share) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t a = root(t[0]), b = root(t[k]);
      if (a != b) parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<double> area(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) area[root(t[0])] += area_vector(mesh, t).norm();
  double largest = 0;
  for (const double a : area) largest = std::max(largest, a);
  const double least = share * largest;
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return area[root(t[0])] < least; });
}

/// Vertices of no triangle go.
void drop_loose(Mesh& mesh) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> at(mesh.vertices.size(), kNone);
  std::vector<Vector3> kept;
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& corner : t) {
      if (at[corner] == kNone) {
        at[corner] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(mesh.vertices[corner]);
      }
      corner = at[corner];
    }
  mesh.vertices = std::move(kept);
}

}  // namespace

Geometry captured_mesh(const DistanceVolume& volume, const CapturedMeshSettings& settings) {
  const VolumePlan& plan = volume.plan();
  const double half = plan.half() / kUnitsPerMetre;
  SurfaceNet net = surface_net({plan.cells, plan.cells, plan.cells}, Vector3(-half, -half, -half),
                               plan.voxel / kUnitsPerMetre, [&](int x, int y, int z) {
                                 const Voxel& voxel = volume.at(x, y, z);
                                 return voxel.weight < settings.least_weight
                                            ? std::numeric_limits<double>::quiet_NaN()
                                            : static_cast<double>(voxel.distance);
                               });
  Geometry geometry;
  if (net.triangles.empty()) return geometry;
  Mesh mesh;
  mesh.vertices = std::move(net.vertices);
  mesh.triangles = std::move(net.triangles);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](std::uint32_t i) { return mesh.vertices[i].z() < settings.table_height; });
  });
  if (mesh.triangles.empty()) return geometry;
  drop_islands(mesh, settings.least_part);
  drop_loose(mesh);
  smooth_grain(mesh, settings.smoothing);
  const auto put = [](const Vector3& v, std::vector<Point3f>& to) { to.push_back(to_point(v)); };
  for (const Vector3& v : mesh.vertices) put(v, geometry.vertices);
  for (const Vector3& n : vertex_normals(mesh)) put(n, geometry.normals);
  geometry.triangles = std::move(mesh.triangles);
  return geometry;
}

double captured_spacing(const Geometry& captured, double sigma) {
  Mesh mesh;
  for (const Point3f& p : captured.vertices) mesh.vertices.push_back(to_vector(p));
  mesh.triangles = captured.triangles;
  const double area = surface_area(mesh);
  const double usual = kSamplingShare * even_spacing(area, kUsualPoints);
  return std::min(
      {4 * sigma, std::max(usual, kVoxelSigmas * sigma), even_spacing(area, limits::kMaxModelKeypoints)});
}

}  // namespace pliant
