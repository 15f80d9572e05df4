// Captures any mesh on a simulated turntable or with a carried sensor, and tells how far the captured surface
// lies off: capture_meshes MESH|bottle DIAGONAL x|y|z "?motion=carried&frames=300". DIAGONAL: metres that the
// mesh is scaled to; the letter: the axis of the file that points upwards.
#include <cstdio>
#include <cstdlib>

#include "drivers/model_files/mesh_cleaning.hpp"
#include "drivers/model_files/mesh_normals.hpp"
#include "drivers/simulated/still_mesh.hpp"
#include "tests/capture/capture_run.hpp"
#include "tests/capture/other_objects.hpp"

namespace pliant::test {
namespace {

/// The file's mesh, scaled, one of its axes upwards.
Result<Geometry> standing_mesh(const std::string& path, double diagonal, int up) {
  if (path == "bottle") return bottle_with_lugs();
  const Result<Geometry> file = read_geometry(path);
  if (!file) return file.error();
  std::vector<std::string> warnings;
  Mesh mesh = clean_mesh(*file, 1, warnings);
  Vector3 low(1e9, 1e9, 1e9), high(-1e9, -1e9, -1e9);
  for (Vector3& v : mesh.vertices) {
    v = Vector3(v((up + 1) % 3), v((up + 2) % 3), v(up));
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  for (Vector3& v : mesh.vertices) v = diagonal / (high - low).norm() * (v - low);
  return with_normals(mesh);
}

int capture_mesh(const std::string& path, double diagonal, int up, const std::string& options) {
  Result<Geometry> mesh = standing_mesh(path, diagonal, up);
  if (!mesh) {
    std::fprintf(stderr, "capture_meshes: %s\n", mesh.error().message.c_str());
    return 2;
  }
  const Result<std::unique_ptr<SimulatedSource>> source = open_still_mesh(std::move(*mesh), options);
  if (!source) {
    std::fprintf(stderr, "capture_meshes: %s\n", source.error().message.c_str());
    return 2;
  }
  CaptureRun run;
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
  if (const char* const ply = std::getenv("CAPTURE_PLY")) static_cast<void>(write_ply(ply, run.captured));
  return 0;
}

}  // namespace
}  // namespace pliant::test

int main(int count, char** words) {
  if (count != 5) {
    std::fputs("usage: capture_meshes MESH|bottle DIAGONAL x|y|z ?motion=turned&frames=300\n", stderr);
    return 2;
  }
  return pliant::test::capture_mesh(words[1], std::atof(words[2]), words[3][0] - 'x', words[4]);
}
