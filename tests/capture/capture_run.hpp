// Captures a simulated object and compares the captured surface with the true one.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/capture/object_capture.hpp"
#include "core/detect/solve6.hpp"
#include "drivers/model_files/captured_mesh.hpp"
#include "drivers/model_files/mesh.hpp"
#include "drivers/model_files/nearest.hpp"
#include "drivers/model_files/surface_sampling.hpp"
#include "drivers/simulated/simulated.hpp"

namespace pliant::test {

/// Distances in metres.
struct CaptureScore {
  double median = 0, p95 = 0;  ///< of captured points from the true surface
  double normals = 0;          ///< degrees that the captured normals are off, root mean square
  double coverage = 0;         ///< share of the surface that was shown
  double seam = 0;   ///< largest step of the error between neighbours, but for the largest thousandth
  double drift = 0;  ///< farthest that a tracked pose lay off the truth, at the object's middle
  std::int64_t fused = 0, frames = 0;
  std::size_t views = 0;  ///< kept
  JointFit joint;
};

struct BlockFree {
  void operator()(std::byte* block) const { std::free(block); }
};
using Block = std::unique_ptr<std::byte, BlockFree>;

inline Block block_of(std::size_t bytes) {
  const std::size_t whole =
      (bytes + Workspace::kAlignment - 1) / Workspace::kAlignment * Workspace::kAlignment;
  return Block(static_cast<std::byte*>(std::aligned_alloc(Workspace::kAlignment, whole)));
}

inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 1e9;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// A capture with its picture of the truth.
class CaptureRun {
 public:
  /// Further noise that the frames get before they are taken in, metres: as much that is each reading's own
  /// as that squares of kNoiseSquare pixels share.
  double extra_noise = 0;

  /// Takes all frames of a simulated source in.
  void run(SimulatedSource& source, const CaptureSettings& settings = {}) {
    block_ = block_of(ObjectCapture::workspace_bytes(source.intrinsics(), source.sensor(), settings));
    ASSERT_EQ(capture.start(source.intrinsics(), source.sensor(), settings,
                            {block_.get(),
                             ObjectCapture::workspace_bytes(source.intrinsics(), source.sensor(), settings)}),
              nullptr);
    const Geometry& truth = source.mesh();
    for (const Point3f& p : truth.vertices) true_mesh.vertices.push_back(to_vector(p));
    true_mesh.triangles = truth.triangles;
    shown.assign(truth.vertices.size(), 0);
    SourceItem item;
    for (;;) {
      source.next(0, item);
      if (item.event != SourceEvent::frame) break;
      const CaptureStatus& status = capture.process(noisier(item.frame));
      const RigidTransform& true_pose = source.truth().parts.front();
      look(source.truth(), truth, true_pose);
      if (status.state != CaptureState::capturing) continue;
      if (score.fused++ == 0) true_from_captured = true_pose.inverse() * status.pose;
      const RigidTransform off = true_pose.inverse() * status.pose * true_from_captured.inverse();
      score.drift = std::max(score.drift, off.translation.norm());
    }
    score.frames = capture.figures().frames;
  }

  void finish(const CapturedMeshSettings& given = {}) {
    score.joint = capture.finish();
    score.views = capture.keyframes().all().size();
    CapturedMeshSettings cleaning = given;
    cleaning.table_height = capture.table_height();
    captured = captured_mesh(capture.volume(), cleaning);
  }

  /// After finish(): fills `score`.
  void compare() {
    std::vector<Vector3> points;
    for (const Point3f& p : captured.vertices) points.push_back(true_from_captured * to_vector(p));
    const OrientedCloud surface = sample_surface(true_mesh, 200000);
    const NearestPoints tree(surface.points);
    settle(points, surface, tree);
    std::vector<double> errors, signed_errors;
    for (const Vector3& p : points) {
      const double e = off_surface(p, surface, tree);
      signed_errors.push_back(e);
      errors.push_back(std::fabs(e));
    }
    score.median = quantile(errors, 0.5);
    score.p95 = quantile(errors, 0.95);
    steps(signed_errors);
    double square_turns = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      double square = 0;
      const Vector3 normal = true_from_captured.rotation * to_vector(captured.normals[i]);
      const double cosine = normal.dot(surface.normals[tree.nearest(points[i], square)]);
      square_turns += std::pow(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI, 2);
    }
    score.normals = std::sqrt(square_turns / static_cast<double>(std::max<std::size_t>(1, points.size())));
    if (points.empty()) return;
    const NearestPoints captured_tree(points);
    std::size_t all = 0, found = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (shown[i] == 0) continue;
      double square = 0;
      static_cast<void>(captured_tree.nearest(true_mesh.vertices[i], square));
      ++all;
      found += square < 0.005 * 0.005 ? 1U : 0U;
    }
    score.coverage = static_cast<double>(found) / static_cast<double>(std::max<std::size_t>(1, all));
  }

  ObjectCapture capture;
  CaptureScore score;
  Geometry captured;
  Mesh true_mesh;
  RigidTransform true_from_captured;
  std::vector<std::uint8_t>
      shown;  ///< of the true mesh's vertices: seen from within 70° in three frames and more

 private:
  static constexpr int kNoiseSquare = 16;
  const DepthFrame& noisier(const DepthFrame& frame) {
    if (extra_noise == 0) return frame;
    noisy_.assign(frame.depth, frame.depth + std::ptrdiff_t{frame.stride} * frame.height);
    std::normal_distribution<double> spread(0, 1000 * extra_noise);  // of millimetres
    std::vector<double> shared(static_cast<std::size_t>(frame.stride / kNoiseSquare + 1));
    for (int v = 0; v < frame.height; ++v) {
      if (v % kNoiseSquare == 0)
        for (double& s : shared) s = spread(random_);
      for (int u = 0; u < frame.width; ++u) {
        std::uint16_t& d = noisy_[static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.stride) +
                                  static_cast<std::size_t>(u)];
        if (d == 0) continue;
        const double off = shared[static_cast<std::size_t>(u / kNoiseSquare)] + spread(random_);
        d = static_cast<std::uint16_t>(std::clamp(std::lround(d + off), 1L, 65535L));
      }
    }
    frame_ = frame;
    frame_.depth = noisy_.data();
    return frame_;
  }
  void look(const SimulatedTruth& truth, const Geometry& mesh, const RigidTransform& pose) {
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (truth.visible[i] == 0 || shown[i] == 255) continue;
      const Vector3 p = to_vector(truth.vertices[i]), n = pose.rotation * to_vector(mesh.normals[i]);
      if (-n.dot(p) > 0.342 * p.norm() && ++seen_[i] == 3) shown[i] = 1;
    }
  }
  static double off_surface(const Vector3& p, const OrientedCloud& surface, const NearestPoints& tree) {
    double square = 0;
    const std::uint32_t i = tree.nearest(p, square);
    const double along = surface.normals[i].dot(p - surface.points[i]);
    // Samples lie 1 mm apart: what is farther aside than that is off an edge or a border.
    const double aside = std::sqrt(std::max(0.0, square - along * along));
    return aside < 0.001 ? along : std::copysign(std::sqrt(square), along);
  }
  /// The captured frame is the first view's, whose own noise is no error of the shape: a rigid fit to the
  /// truth.
  void settle(std::vector<Vector3>& points, const OrientedCloud& surface, const NearestPoints& tree) {
    for (int round = 0; round < 6 && points.size() > 100; ++round) {
      NormalEquations6 equations;
      Vector3 middle = Vector3::Zero();
      for (const Vector3& p : points) middle += p / static_cast<double>(points.size());
      for (std::size_t k = 0; k < points.size(); k += 7) {
        const Vector3& p = points[k];
        double square = 0;
        const std::uint32_t i = tree.nearest(p, square);
        if (square > 0.01 * 0.01) continue;
        const Vector3& n = surface.normals[i];
        const Vector3 arm = cross(p - middle, n);
        const double row[6] = {arm.x(), arm.y(), arm.z(), n.x(), n.y(), n.z()};
        equations.add(row, n.dot(surface.points[i] - p), 1);
      }
      Vector3 turn, shift;
      if (!equations.solve(1e-9, 1e-9, turn, shift)) return;
      const Matrix3 rotation = rotation_from_small_vector(turn);
      RigidTransform step;
      step.rotation = rotation;
      step.translation = middle + shift - rotation * middle;
      for (Vector3& p : points) p = step * p;
      true_from_captured = step * true_from_captured;
    }
  }
  void steps(const std::vector<double>& errors) {
    std::vector<double> all;
    for (const auto& t : captured.triangles)
      for (std::size_t k = 0; k < 3; ++k) all.push_back(std::fabs(errors[t[k]] - errors[t[(k + 1) % 3]]));
    score.seam = quantile(all, 0.999);
  }

  Block block_;
  std::mt19937 random_{17};
  std::vector<std::uint16_t> noisy_;
  DepthFrame frame_;
  std::array<std::uint8_t, 65536> seen_{};
};

inline std::unique_ptr<SimulatedSource> simulated(const std::string& text) {
  Result<std::unique_ptr<SimulatedSource>> source = open_simulated(text);
  EXPECT_TRUE(source) << text;
  return source ? std::move(*source) : nullptr;
}

}  // namespace pliant::test
