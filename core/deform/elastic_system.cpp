#include "core/deform/elastic_system.hpp"

namespace pliant {

void ElasticSystem::clear(std::size_t patches) noexcept {
  count_ = patches;
  links_count_ = 0;
  for (std::size_t p = 0; p < count_; ++p) {
    own_[p] = block_[p] = Symmetric6();
    force_[p] = Vector6::Zero();
  }
}

void ElasticSystem::add_link(const ElasticLink& link, const Vector3& gap, const Vector3& turn) noexcept {
  if (links_count_ == links_.size()) return;
  links_[links_count_++] = link;
  block_[link.a].add_point_spring(link.stretch, link.arm_a);
  block_[link.b].add_point_spring(link.stretch, link.arm_b);
  block_[link.a].add_turn_spring(link.bend);
  block_[link.b].add_turn_spring(link.bend);
  const Vector3 pull = link.stretch * gap, twist = link.bend * turn;
  force_[link.a].head<3>() -= link.arm_a.cross(pull) + twist;
  force_[link.a].tail<3>() -= pull;
  force_[link.b].head<3>() += link.arm_b.cross(pull) + twist;
  force_[link.b].tail<3>() += pull;
}

void ElasticSystem::multiply(const Vectors& x, Vectors& y) const noexcept {
  for (std::size_t p = 0; p < count_; ++p) y[p] = own_[p] * x[p];
  for (std::size_t l = 0; l < links_count_; ++l) {
    const ElasticLink& link = links_[l];
    const Vector6 &xa = x[link.a], &xb = x[link.b];
    const Vector3 wa = xa.head<3>(), wb = xb.head<3>();
    const Vector3 gap =
        Vector3(xa.tail<3>()) + wa.cross(link.arm_a) - Vector3(xb.tail<3>()) - wb.cross(link.arm_b);
    const Vector3 pull = link.stretch * gap, twist = link.bend * (wa - wb);
    y[link.a].head<3>() += link.arm_a.cross(pull) + twist;
    y[link.a].tail<3>() += pull;
    y[link.b].head<3>() -= link.arm_b.cross(pull) + twist;
    y[link.b].tail<3>() -= pull;
  }
}

double ElasticSystem::dot(const Vectors& x, const Vectors& y) const noexcept {
  double sum = 0;
  for (std::size_t p = 0; p < count_; ++p)
    for (int i = 0; i < 6; ++i) sum += x[p][i] * y[p][i];
  return sum;
}

bool ElasticSystem::solve(int iterations) noexcept {
  for (std::size_t p = 0; p < count_; ++p) {
    for (std::size_t k = 0; k < 21; ++k) block_[p].a[k] += own_[p].a[k];
    if (!factor_[p].factorise(block_[p])) return false;
    x_[p] = Vector6::Zero();
    residual_[p] = force_[p];
    direction_[p] = factor_[p].solve(force_[p]);
  }
  double along = dot(residual_, direction_);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    multiply(direction_, scratch_);
    const double curvature = dot(direction_, scratch_);
    if (!(curvature > 1e-30) || !(along > 1e-30)) break;
    const double step = along / curvature;
    for (std::size_t p = 0; p < count_; ++p) {
      x_[p] += step * direction_[p];
      residual_[p] -= step * scratch_[p];
      scratch_[p] = factor_[p].solve(residual_[p]);
    }
    const double next = dot(residual_, scratch_);
    const double keep = next / along;
    along = next;
    for (std::size_t p = 0; p < count_; ++p) direction_[p] = scratch_[p] + keep * direction_[p];
  }
  return true;
}

}  // namespace pliant
