// What programs that register shared data have in common: aligned memory, built models, ground truth.
#pragma once

#include <ctime>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/registration/cloud_registration.hpp"
#include "drivers/geometry_files/geometry.hpp"
#include "drivers/model_files/model_builder.hpp"

namespace pliant {

/// A block aligned for a Workspace.
struct AlignedBlock {
  explicit AlignedBlock(std::size_t size) : raw(size + Workspace::kAlignment) {
    void* at = raw.data();
    std::size_t space = raw.size();
    std::align(Workspace::kAlignment, size, at, space);
    bytes = {static_cast<std::byte*>(at), size};
  }
  std::vector<std::byte> raw;
  std::span<std::byte> bytes;
};

/// A model built from a mesh or cloud; `good` is false where the file is missing or of no use.
struct BuiltFromFile {
  explicit BuiltFromFile(const std::filesystem::path& file) : block(0) {
    const Result<Geometry> geometry = read_geometry(file);
    if (geometry) build(*geometry);
  }
  explicit BuiltFromFile(const Geometry& geometry) : block(0) { build(geometry); }
  AlignedBlock block;
  ModelView view;
  bool good = false;

 private:
  void build(const Geometry& geometry) {
    const Result<BuiltModel> built = build_model(geometry, ModelBuildSettings());
    if (!built) return;
    block = AlignedBlock(built->image.size());
    std::memcpy(block.bytes.data(), built->image.data(), built->image.size());
    good = ModelView::open(block.bytes, view) == ModelFault::none;
  }
};

/// A registration with its memory; `fault` says why it cannot run, null when it can.
struct ReadyRegistration {
  ReadyRegistration(const ModelView& model, std::size_t points, const RegistrationSettings& settings = {})
      : block(CloudRegistration::workspace_bytes(model, points, settings)),
        fault(registration.start(model, points, settings, block.bytes)) {}
  AlignedBlock block;
  CloudRegistration registration;
  const char* fault;
};

/// What is true of a scene point: the nearest model vertex, its label, where it lies on the undeformed model.
struct TruePoint {
  int index = -1, label = 0;
  Point3f rest;
};

/// One a scene point.
inline std::vector<TruePoint> read_true_points(const std::filesystem::path& file) {
  std::vector<TruePoint> points;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);  // the columns' names
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    TruePoint point;
    fields >> point.index >> point.label >> point.rest.x >> point.rest.y >> point.rest.z;
    points.push_back(point);
  }
  return points;
}

/// The parts' true poses (scene <- model).
inline std::vector<RigidTransform> read_true_poses(const std::filesystem::path& file) {
  std::vector<RigidTransform> poses;
  std::ifstream in(file);
  std::string word;
  while (in >> word) {
    if (word != "part") continue;
    in >> word;  // its name
    RigidTransform pose;
    double last[4];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) in >> pose.rotation(i, j);
      in >> pose.translation(i);
    }
    for (double& x : last) in >> x;
    poses.push_back(pose);
  }
  return poses;
}

inline double degrees_between(const Matrix3& a, const Matrix3& b) {
  return std::acos(std::clamp(cos_angle(a.transpose() * b), -1.0, 1.0)) * 180 / M_PI;
}

/// Milliseconds of this thread alone: other programs on the machine do not count.
inline double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

inline double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Thread time of each stage of one registration; the model's own stages are left out.
struct StageClock {
  double ms[kRegistrationStageCount] = {};
  double last = 0;

  void begin() {
    for (double& m : ms) m = 0;
    last = thread_ms();
  }
  [[nodiscard]] double total() const {
    double sum = 0;
    for (const double m : ms) sum += m;
    return sum;
  }
  [[nodiscard]] RegistrationObserver observer() { return {&StageClock::stamp, this}; }

 private:
  static void stamp(void* context, RegistrationStage stage, bool model_side) {
    auto* self = static_cast<StageClock*>(context);
    const double now = thread_ms();
    if (!model_side) self->ms[static_cast<int>(stage)] += now - self->last;
    self->last = now;
  }
};

}  // namespace pliant
