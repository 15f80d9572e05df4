// Captures any mesh on a simulated turntable or with a carried sensor, and tells how far the captured surface
// lies off: capture_meshes MESH|bottle|plain-bottle|ball DIAGONAL x|y|z "?motion=carried&frames=300"
// [CAPTURED.ply [MM]]. DIAGONAL: metres that the mesh is scaled to, 0 as it is; the letter: the axis of the
// file that points upwards. The captured surface is written in the frame of MESH ("" for none). MM: further
// noise of the readings, millimetres (CaptureRun::extra_noise).
#include <cstdio>
#include <cstdlib>

#include "drivers/model_files/mesh_cleaning.hpp"
#include "drivers/model_files/mesh_normals.hpp"
#include "drivers/simulated/still_mesh.hpp"
#include "tests/capture/capture_run.hpp"
#include "tests/capture/other_objects.hpp"

namespace pliant::test {
namespace {

/// A mesh and where it stands.
struct Standing {
  Geometry mesh;                       // as it is put before the sensor
  Matrix3 turn = Matrix3::Identity();  // standing <- file: x -> scale * turn * x + shift
  double scale = 1;
  Vector3 shift = Vector3::Zero();
};

/// The file's mesh, scaled, one of its axes upwards.
Result<Standing> standing_mesh(const std::string& path, double diagonal, int up) {
  Standing standing;
  if (path == "bottle" || path == "plain-bottle" || path == "ball") {
    standing.mesh = path == "ball" ? ball() : path == "bottle" ? bottle_with_lugs() : plain_bottle();
    return standing;
  }
  const Result<Geometry> file = read_geometry(path);
  if (!file) return file.error();
  std::vector<std::string> warnings;
  Mesh mesh = clean_mesh(*file, 1, warnings);
  Vector3 low(1e9, 1e9, 1e9), high(-1e9, -1e9, -1e9);
  for (int axis = 0; axis < 3; ++axis) standing.turn.row(axis) = Vector3::Unit((up + 1 + axis) % 3);
  for (Vector3& v : mesh.vertices) {
    v = standing.turn * v;
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  standing.scale = diagonal > 0 ? diagonal / (high - low).norm() : 1;
  standing.shift = -standing.scale * low;
  for (Vector3& v : mesh.vertices) v = standing.scale * v + standing.shift;
  standing.mesh = with_normals(mesh);
  return standing;
}

/// `captured` in the frame of the file.
Geometry in_frame_of_file(const Geometry& captured, const RigidTransform& standing_from_captured,
                          const Standing& standing) {
  Mesh mesh;
  mesh.triangles = captured.triangles;
  for (const Point3f& p : captured.vertices)
    mesh.vertices.push_back(standing.turn.transpose() *
                            (standing_from_captured * to_vector(p) - standing.shift) / standing.scale);
  return with_normals(mesh);
}

int capture_mesh(const std::string& path, double diagonal, int up, const std::string& options,
                 const std::string& ply, double extra_noise) {
  Result<Standing> mesh = standing_mesh(path, diagonal, up);
  if (!mesh) {
    std::fprintf(stderr, "capture_meshes: %s\n", mesh.error().message.c_str());
    return 2;
  }
  const Result<std::unique_ptr<SimulatedSource>> source = open_still_mesh(mesh->mesh, options);
  if (!source) {
    std::fprintf(stderr, "capture_meshes: %s\n", source.error().message.c_str());
    return 2;
  }
  CaptureRun run;
  run.extra_noise = 0.001 * extra_noise;
  run.run(**source);
  CapturedMeshSettings cleaning;
  if (const char* const smoothing = std::getenv("CAPTURE_SMOOTHING"))
    cleaning.smoothing = std::atoi(smoothing);
  run.finish(cleaning);
  run.compare();
  const CaptureScore& s = run.score;
  std::printf(
      "| %s | %s | %lld of %lld | %.2f mm | %.2f mm | %.1f %% | %.2f mm | %.2f mm | %.2f to %.2f mm | %.1f° "
      "| "
      "%d of 8 sides, %lld featureless |\n",
      std::filesystem::path(path).stem().c_str(), options.c_str(), static_cast<long long>(s.fused),
      static_cast<long long>(s.frames), 1e3 * s.median, 1e3 * s.p95, 100 * s.coverage, 1e3 * s.seam,
      1e3 * s.drift, 1e3 * s.joint.before, 1e3 * s.joint.after, s.normals,
      run.capture.coverage().sectors_seen(), static_cast<long long>(run.capture.figures().featureless));
  if (ply.empty()) return 0;
  const Outcome written = write_ply(ply, in_frame_of_file(run.captured, run.true_from_captured, *mesh));
  if (written) return 0;
  std::fprintf(stderr, "capture_meshes: %s\n", written.error().message.c_str());
  return 3;
}

}  // namespace
}  // namespace pliant::test

int main(int count, char** words) {
  if (count < 5 || count > 7) {
    std::fputs(
        "usage: capture_meshes MESH|bottle|plain-bottle|ball DIAGONAL x|y|z ?motion=turned&frames=300 "
        "[CAPTURED.ply [MM]]\n",
        stderr);
    return 2;
  }
  return pliant::test::capture_mesh(words[1], std::atof(words[2]), words[3][0] - 'x', words[4],
                                    count > 5 ? words[5] : "", count > 6 ? std::atof(words[6]) : 0);
}
