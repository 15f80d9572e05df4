#include "firmware-app/demo/truth_check.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pliant::demo {

namespace {

/// Sums from which the best rigid motion between two sets of points follows.
struct Moments {
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();
  Matrix3 product = Matrix3::Zero();
  int count = 0;
  void add(const Vector3& a, const Vector3& b) {
    from += a;
    to += b;
    product += b * a.transpose();
    ++count;
  }
  /// Least squares (Kabsch).
  [[nodiscard]] RigidTransform motion() const {
    const Matrix3 spread = product - to * from.transpose() / count;
    const Eigen::JacobiSVD<Matrix3> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
    RigidTransform motion;
    motion.rotation = svd.matrixU() * Vector3(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
    motion.translation = (to - motion.rotation * from) / count;
    return motion;
  }
};

}  // namespace

RememberingSource::RememberingSource(std::unique_ptr<SimulatedSource> source) : source_(std::move(source)) {
  for (Memory& memory : memories_) memory.vertices.resize(source_->mesh().vertices.size());
}

void RememberingSource::next(int timeout_ms, SourceItem& item) {
  source_->next(timeout_ms, item);
  if (item.event != SourceEvent::frame) return;
  const SimulatedTruth& truth = source_->truth();
  const std::lock_guard lock(mutex_);
  Memory& memory = memories_[next_];
  next_ = (next_ + 1) % memories_.size();
  memory.number = item.frame.number;
  memory.present = truth.present;
  memory.base = truth.parts.front();
  std::copy(truth.vertices.begin(), truth.vertices.end(), memory.vertices.begin());
}

bool RememberingSource::recall(std::int64_t number, Memory& memory) const {
  const std::lock_guard lock(mutex_);
  for (const Memory& known : memories_)
    if (known.number == number) {
      memory.number = number;
      memory.present = known.present;
      memory.base = known.base;
      std::copy(known.vertices.begin(), known.vertices.end(), memory.vertices.begin());
      return true;
    }
  return false;
}

TruthCheck::TruthCheck(const ModelView& model, const RememberingSource& source)
    : source_(source), mesh_rest_(source.mesh().vertices) {
  truth_.vertices.resize(mesh_rest_.size());
  // Each model point follows its three nearest vertices, the nearer the more: exact where it is a vertex.
  for (const Point3f& point : model.positions()) {
    const Vector3 p = to_vector(point);
    std::array<double, 3> nearest;
    nearest.fill(std::numeric_limits<double>::max());
    Place place;
    for (std::uint32_t v = 0; v < mesh_rest_.size(); ++v) {
      double square = (to_vector(mesh_rest_[v]) - p).squaredNorm();
      std::uint32_t vertex = v;
      for (std::size_t k = 0; k < nearest.size(); ++k)
        if (square < nearest[k]) {
          std::swap(square, nearest[k]);
          std::swap(vertex, place.vertices[k]);
        }
    }
    double sum = 0;
    for (std::size_t k = 0; k < nearest.size(); ++k) sum += place.weights[k] = 1 / (nearest[k] + 1e-12);
    for (double& weight : place.weights) weight /= sum;
    rest_.push_back(p);
    places_.push_back(place);
  }
  where_.resize(places_.size());
}

void TruthCheck::look(const TrackResult& result) {
  if (!source_.recall(result.frame, truth_)) return;
  const bool tracked = result.state == TrackState::tracking;
  present_ += truth_.present ? 1 : 0;
  present_and_tracked_ += truth_.present && tracked ? 1 : 0;
  claimed_while_gone_ += !truth_.present && tracked ? 1 : 0;
  if (!tracked || !truth_.present) return;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    // The base's motion carries the point exactly; what the mesh does beyond it is interpolated.
    Vector3& where = where_[i];
    where = truth_.base * rest_[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = places_[i].vertices[k];
      where +=
          places_[i].weights[k] * (to_vector(truth_.vertices[v]) - truth_.base * to_vector(mesh_rest_[v]));
    }
    if (result.labels[i] != kNotObserved)
      position_.add(std::llround((to_vector(result.positions[i]) - where).norm() * 1e6));
  }
  if (!result.regions.empty() && result.regions.front().id == 0) compare_base(result);
}

void TruthCheck::compare_base(const TrackResult& result) {
  Moments moments;
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (result.labels[i] == 0) moments.add(rest_[i], where_[i]);
  if (moments.count < 3) return;
  const RigidTransform truth = moments.motion();
  const Vector3 middle = moments.from / moments.count;
  base_shift_.add(std::llround((result.pose * middle - truth * middle).norm() * 1e6));
  const double cosine = cos_angle(truth.rotation.transpose() * result.pose.rotation);
  base_angle_.add(std::llround(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180e3 / std::numbers::pi));
}

}  // namespace pliant::demo
