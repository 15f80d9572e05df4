#include "core/capture/joint_alignment.hpp"

#include <algorithm>
#include <cmath>

#include "core/track/plane_equations.hpp"

namespace pliant {

namespace {

constexpr int kRounds = 12;
constexpr std::size_t kFewestPairRows = 100;
constexpr double kCosPair = 0.5;  // 60°: beyond it two views of a round thing share next to nothing
// Views that nothing holds stay where they are: two thousandths of what a usual pair's thousand rows say of a
// turn (at 0.1 m) and a shift.
constexpr double kKeepTurn = 0.02, kKeepShift = 2;
constexpr double kPinned = 1e9;  // the first view
constexpr double kDone = 1e-5;   // metres

}  // namespace

void JointAlignment::lay_out(Workspace& workspace) noexcept {
  matrix_ = workspace.take<double>(kUnknowns * kUnknowns);
  right_ = workspace.take<double>(kUnknowns);
}

bool JointAlignment::solve(std::size_t n) noexcept {
  // LDLᵀ without pivoting in the lower triangle: the matrix is positive definite by its diagonal.
  const auto row = [&](std::size_t i) { return matrix_.data() + i * kUnknowns; };
  for (std::size_t i = 0; i < n; ++i) {
    double* const li = row(i);
    for (std::size_t j = 0; j < i; ++j) {
      const double* const lj = row(j);
      double sum = li[j];
      for (std::size_t k = 0; k < j; ++k) sum -= li[k] * lj[k];
      li[j] = sum;  // L(i, j) · D(j), until the row is whole
    }
    double d = li[i];
    for (std::size_t j = 0; j < i; ++j) {
      const double scaled = li[j] / row(j)[j];
      d -= scaled * li[j];
      li[j] = scaled;
    }
    if (!(d > 0)) return false;
    li[i] = d;
    for (std::size_t j = 0; j < i; ++j) right_[i] -= li[j] * right_[j];
  }
  for (std::size_t i = 0; i < n; ++i) right_[i] /= row(i)[i];
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t k = i + 1; k < n; ++k) right_[i] -= row(k)[i] * right_[k];
  return true;
}

JointFit JointAlignment::run(std::span<Keyframe> views, const Projector& projector, const Surface& rays,
                             std::int32_t noise, double gate, std::span<PlaneRow> rows) noexcept {
  JointFit fit;
  if (views.size() < 2) return fit;
  const std::size_t n = 6 * views.size();
  const IntPoint origin{0, 0, 0};
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < n; ++i) std::fill_n(matrix_.data() + i * kUnknowns, n, 0.0);
    std::fill_n(right_.data(), n, 0.0);
    const double narrowing = std::max(0.25, 1 - 0.15 * round);
    const auto reach = static_cast<std::int32_t>(gate * narrowing * kUnitsPerMetre);
    fit.pairs = 0;
    double square = 0, weight = 0;
    const auto add = [&](std::size_t a, std::size_t b, const Matrix6& m, double sign) {
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          matrix_[(6 * a + static_cast<std::size_t>(i)) * kUnknowns + 6 * b + static_cast<std::size_t>(j)] +=
              sign * m(i, j);
    };
    for (std::size_t a = 0; a < views.size(); ++a)
      for (std::size_t b = 0; b < views.size(); ++b) {
        // The camera's axis in the model's frame is the third row of camera <- model.
        if (a == b ||
            Vector3(views[a].view.pose.rotation.row(2)).dot(Vector3(views[b].view.pose.rotation.row(2))) <
                kCosPair)
          continue;
        const std::size_t count =
            pair_rows(views[a].sampled(), views[a].view.pose, views[b].view, projector, rays, reach, rows);
        if (count < kFewestPairRows) continue;
        const RobustMoments robust = robust_moments(rows.first(count), noise, origin);
        const PlaneEquations equations = plane_equations(robust.moments);
        ++fit.pairs;
        square += static_cast<double>(robust.moments.square);
        weight += static_cast<double>(robust.moments.weight);
        add(a, a, equations.a, 1);
        add(b, b, equations.a, 1);
        add(a, b, equations.a, -1);
        add(b, a, equations.a, -1);
        for (int i = 0; i < 6; ++i) {
          right_[6 * a + static_cast<std::size_t>(i)] += equations.b[i];
          right_[6 * b + static_cast<std::size_t>(i)] -= equations.b[i];
        }
      }
    fit.after = weight > 0 ? std::sqrt(square / weight) * kResidualMetres : 0;
    if (round == 0) fit.before = fit.after;
    if (round + 1 == kRounds) break;
    for (std::size_t i = 0; i < n; ++i)
      matrix_[i * kUnknowns + i] += i < 6 ? kPinned : i % 6 < 3 ? kKeepTurn : kKeepShift;
    if (!solve(n)) break;
    double largest = 0;
    for (std::size_t k = 1; k < views.size(); ++k) {
      Vector6 x;
      for (int i = 0; i < 6; ++i) x[i] = right_[6 * k + static_cast<std::size_t>(i)];
      if (!(x.squaredNorm() < 1.0)) continue;
      RigidTransform& pose = views[k].view.pose;
      const RigidTransform before = pose.inverse();
      RigidTransform moved = motion_about(x, Vector3::Zero()) * before;
      moved.rotation = orthonormalised(moved.rotation);
      pose = moved.inverse();
      largest = std::max(largest, (moved.translation - before.translation).norm());
    }
    fit.moved = std::max(fit.moved, largest);
    if (largest < kDone) break;
  }
  return fit;
}

}  // namespace pliant
