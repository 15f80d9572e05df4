#include "core/deform/elastic_system.hpp"

namespace pliant {

namespace {

/// The end of a link at one patch: what it resists and which way it pulls.
void add_end(double stretch, double bend, const Vector3& arm, const Vector3& pull, const Vector3& twist,
             Symmetric6& matrix, Vector6& force) noexcept {
  matrix.add_point_spring(stretch, arm);
  matrix.add_turn_spring(bend);
  force.head<3>() += arm.cross(pull) + twist;
  force.tail<3>() += pull;
}

/// What a link answers to the motions of its ends. In plain numbers: this is the innermost loop.
inline void multiply_link(const ElasticLink& link, const Vector6& at_a, const Vector6& at_b, Vector6& out_a,
                          Vector6& out_b) noexcept {
  const double *xa = at_a.data(), *xb = at_b.data(), *ra = link.arm_a.data(), *rb = link.arm_b.data();
  const double pull_x =
      link.stretch * (xa[3] + xa[1] * ra[2] - xa[2] * ra[1] - xb[3] - xb[1] * rb[2] + xb[2] * rb[1]);
  const double pull_y =
      link.stretch * (xa[4] + xa[2] * ra[0] - xa[0] * ra[2] - xb[4] - xb[2] * rb[0] + xb[0] * rb[2]);
  const double pull_z =
      link.stretch * (xa[5] + xa[0] * ra[1] - xa[1] * ra[0] - xb[5] - xb[0] * rb[1] + xb[1] * rb[0]);
  const double twist_x = link.bend * (xa[0] - xb[0]), twist_y = link.bend * (xa[1] - xb[1]),
               twist_z = link.bend * (xa[2] - xb[2]);
  double *ya = out_a.data(), *yb = out_b.data();
  ya[0] += ra[1] * pull_z - ra[2] * pull_y + twist_x;
  ya[1] += ra[2] * pull_x - ra[0] * pull_z + twist_y;
  ya[2] += ra[0] * pull_y - ra[1] * pull_x + twist_z;
  ya[3] += pull_x;
  ya[4] += pull_y;
  ya[5] += pull_z;
  yb[0] -= rb[1] * pull_z - rb[2] * pull_y + twist_x;
  yb[1] -= rb[2] * pull_x - rb[0] * pull_z + twist_y;
  yb[2] -= rb[0] * pull_y - rb[1] * pull_x + twist_z;
  yb[3] -= pull_x;
  yb[4] -= pull_y;
  yb[5] -= pull_z;
}

}  // namespace

void ElasticSystem::clear(std::size_t patches) noexcept {
  count_ = patches;
  links_count_ = 0;
  for (std::size_t p = 0; p < count_; ++p) {
    own_[p] = block_[p] = Symmetric6();
    force_[p] = x_[p] = Vector6::Zero();
    held_[p] = false;
  }
}

void ElasticSystem::add_link(const ElasticLink& link, const Vector3& gap, const Vector3& turn) noexcept {
  const bool both = !held_[link.a] && !held_[link.b];
  if ((held_[link.a] && held_[link.b]) || (both && links_count_ == links_.size())) return;
  if (both) links_[links_count_++] = link;
  // To the other end a held patch is a wall.
  const Vector3 pull = link.stretch * gap, twist = link.bend * turn;
  if (!held_[link.a])
    add_end(link.stretch, link.bend, link.arm_a, -pull, -twist, (both ? block_ : own_)[link.a],
            force_[link.a]);
  if (!held_[link.b])
    add_end(link.stretch, link.bend, link.arm_b, pull, twist, (both ? block_ : own_)[link.b], force_[link.b]);
}

void ElasticSystem::multiply(const Vectors& x, Vectors& y) const noexcept {
  for (std::size_t m = 0; m < moving_count_; ++m) y[moving_[m]] = own_[moving_[m]] * x[moving_[m]];
  for (std::size_t l = 0; l < links_count_; ++l) {
    const ElasticLink& link = links_[l];
    multiply_link(link, x[link.a], x[link.b], y[link.a], y[link.b]);
  }
}

double ElasticSystem::dot(const Vectors& x, const Vectors& y) const noexcept {
  double sum = 0;
  for (std::size_t m = 0; m < moving_count_; ++m)
    for (int i = 0; i < 6; ++i) sum += x[moving_[m]][i] * y[moving_[m]][i];
  return sum;
}

bool ElasticSystem::solve(int iterations, double enough) noexcept {
  moving_count_ = 0;
  for (std::size_t p = 0; p < count_; ++p)
    if (!held_[p]) moving_[moving_count_++] = static_cast<std::uint8_t>(p);
  for (std::size_t m = 0; m < moving_count_; ++m) {
    const std::size_t p = moving_[m];
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
    if (!(curvature > 1e-30) || !(along > enough)) break;
    const double step = along / curvature;
    double next = 0;
    for (std::size_t m = 0; m < moving_count_; ++m) {
      const std::size_t p = moving_[m];
      x_[p] += step * direction_[p];
      residual_[p] -= step * scratch_[p];
      scratch_[p] = factor_[p].solve(residual_[p]);
      // as dot() adds it up, while the next patch is solved
      for (int i = 0; i < 6; ++i) next += residual_[p][i] * scratch_[p][i];
    }
    const double keep = next / along;
    along = next;
    for (std::size_t m = 0; m < moving_count_; ++m)
      direction_[moving_[m]] = scratch_[moving_[m]] + keep * direction_[moving_[m]];
  }
  return true;
}

}  // namespace pliant
