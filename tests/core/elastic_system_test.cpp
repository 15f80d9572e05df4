#include "core/deform/elastic_system.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <memory>
#include <random>
#include <vector>

namespace pliant {
namespace {

class Draw {
 public:
  double operator()() { return spread_(engine_); }
  Vector3 vector() { return {(*this)(), (*this)(), (*this)()}; }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> spread_{-1, 1};
};

Matrix6 dense(Symmetric6 s) {
  Matrix6 m;
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column <= row; ++column)
      m(static_cast<int>(row), static_cast<int>(column)) =
          m(static_cast<int>(column), static_cast<int>(row)) = s.at(row, column);
  return m;
}

/// How a point at `arm` moves with (turn, shift).
Eigen::Matrix<double, 3, 6> point_rows(const Vector3& arm) {
  Eigen::Matrix<double, 3, 6> j;
  for (int column = 0; column < 3; ++column) {
    j.col(column) = Vector3(Vector3::Unit(column)).cross(arm);
    j.col(column + 3) = Vector3::Unit(column);
  }
  return j;
}

TEST(Symmetric6, APointSpringIsTheSquareOfItsMotion) {
  Draw draw;
  for (int i = 0; i < 20; ++i) {
    const Vector3 arm = draw.vector();
    const double k = 1.5 + draw();
    Symmetric6 s;
    s.add_point_spring(k, arm);
    const Matrix6 expected = k * point_rows(arm).transpose() * point_rows(arm);
    EXPECT_LT((dense(s) - expected).norm(), 1e-12);
    Vector6 x;
    for (int j = 0; j < 6; ++j) x[j] = draw();
    EXPECT_LT((s * x - expected * x).norm(), 1e-12);
  }
}

TEST(Factor6, SolvesWhatADenseSolverSolves) {
  Draw draw;
  for (int i = 0; i < 20; ++i) {
    Symmetric6 s;
    for (int j = 0; j < 4; ++j) s.add_point_spring(1.1 + draw(), draw.vector());
    s.add_turn_spring(0.01);
    Vector6 b;
    for (int j = 0; j < 6; ++j) b[j] = draw();
    Factor6 factor;
    ASSERT_TRUE(factor.factorise(s));
    EXPECT_LT((dense(s) * factor.solve(b) - b).norm(), 1e-9);
  }
}

TEST(Factor6, RefusesWhatIsNotPositiveDefinite) {
  Factor6 factor;
  EXPECT_FALSE(factor.factorise(Symmetric6()));
  Symmetric6 s;
  s.add_turn_spring(1);
  s.add_shift_spring(-1);
  EXPECT_FALSE(factor.factorise(s));
}

/// A chain of patches with a cross link, the first held, the last pulled; beside it the same in one dense
/// matrix.
class Chain : public ::testing::Test {
 protected:
  static constexpr std::size_t kPatches = 12;
  static constexpr int kUnknowns = 6 * kPatches;
  using Dense = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Column = Eigen::Matrix<double, kUnknowns, 1>;

  Chain() {
    system_->clear(kPatches);
    for (std::size_t p = 0; p < kPatches; ++p) {
      own(p, 0.02, 0.001);
      if (p + 1 < kPatches) link(p, p + 1, 5, 0.1);
    }
    link(2, 8, 3, 0.05);
    link(1, 10, 2, 0);  // across the body: turning is free
    link(4, 7, 0.5, 0);
    own(0, 100, 10);
    Vector6 pull = Vector6::Zero();
    pull << 0.01, -0.02, 0.03, 0.1, 0.2, -0.1;
    system_->force(kPatches - 1) += pull;
    force_.tail<6>() += pull;
  }
  void own(std::size_t p, double shift, double turn) {
    system_->own(p).add_shift_spring(shift);
    system_->own(p).add_turn_spring(turn);
    const auto at = static_cast<Eigen::Index>(6 * p);
    matrix_.block<3, 3>(at, at) += turn * Matrix3::Identity();
    matrix_.block<3, 3>(at + 3, at + 3) += shift * Matrix3::Identity();
  }
  void link(std::size_t a, std::size_t b, double stretch, double bend) {
    const Vector3 gap = 0.01 * draw_.vector(), turn = 0.1 * draw_.vector();
    ElasticLink link;
    link.a = static_cast<std::uint8_t>(a);
    link.b = static_cast<std::uint8_t>(b);
    link.stretch = stretch;
    link.bend = bend;
    link.arm_a = 0.1 * draw_.vector();
    link.arm_b = 0.1 * draw_.vector();
    system_->add_link(link, gap, turn);
    Eigen::Matrix<double, 6, kUnknowns> rows =
        Eigen::Matrix<double, 6, kUnknowns>::Zero();  // gap and turn that the motions add
    const auto at_a = static_cast<Eigen::Index>(6 * a), at_b = static_cast<Eigen::Index>(6 * b);
    rows.block<3, 6>(0, at_a) = point_rows(link.arm_a);
    rows.block<3, 6>(0, at_b) = -point_rows(link.arm_b);
    rows.block<3, 3>(3, at_a) = Matrix3::Identity();
    rows.block<3, 3>(3, at_b) = -Matrix3::Identity();
    Vector6 weight, rest;
    weight << stretch, stretch, stretch, bend, bend, bend;
    rest << gap, turn;
    matrix_ += rows.transpose() * weight.asDiagonal() * rows;
    force_ -= rows.transpose() * weight.asDiagonal() * rest;
  }
  [[nodiscard]] double energy() const {
    Column x;
    for (std::size_t p = 0; p < kPatches; ++p)
      x.segment<6>(static_cast<Eigen::Index>(6 * p)) = system_->motion(p);
    return 0.5 * x.dot(matrix_ * x) - force_.dot(x);
  }
  [[nodiscard]] double least_energy() const {
    const Column x = matrix_.ldlt().solve(force_);
    return 0.5 * x.dot(matrix_ * x) - force_.dot(x);
  }

  Draw draw_;
  std::unique_ptr<ElasticSystem> system_ = std::make_unique<ElasticSystem>();
  Dense matrix_ = Dense::Zero();
  Column force_ = Column::Zero();
};

TEST_F(Chain, ComesToTheBalanceThatADenseSolverFinds) {
  ASSERT_TRUE(system_->solve(64));
  const Column expected = matrix_.ldlt().solve(force_);
  for (std::size_t p = 0; p < kPatches; ++p)
    EXPECT_LT((system_->motion(p) - expected.segment<6>(static_cast<Eigen::Index>(6 * p))).norm(),
              1e-6 * expected.norm())
        << p;
}

TEST_F(Chain, EveryIterationBringsItNearer) {
  double last = 0;  // of no motion
  for (const int iterations : {1, 2, 4, 8, 16, 32}) {
    ASSERT_TRUE(system_->solve(iterations));
    // solve() may be called again: it starts from no motion
    EXPECT_LE(energy(), last + 1e-12) << iterations;
    last = energy();
  }
  EXPECT_LT(last - least_energy(), 1e-3 * -least_energy());
}

TEST_F(Chain, EndsWhenLittleIsLeftUnbalanced) {
  ASSERT_TRUE(system_->solve(64));
  const double least = energy(), all = -least;
  ASSERT_TRUE(system_->solve(64, 1e9 * all));
  EXPECT_EQ(energy(), 0) << "all that is unbalanced is worth less than that: nothing moves";
  ASSERT_TRUE(system_->solve(64, 0.01 * all));
  EXPECT_GT(energy(), least);
  EXPECT_LT(energy() - least, 0.1 * all);
}

TEST(ElasticSystem, SaysThatNothingHoldsAPatch) {
  const auto system = std::make_unique<ElasticSystem>();
  system->clear(2);
  EXPECT_FALSE(system->solve(8));
}

TEST(ElasticSystem, StaysWhereNothingPulls) {
  const auto system = std::make_unique<ElasticSystem>();
  system->clear(1);
  system->own(0).add_point_spring(1, Vector3::Zero());
  system->own(0).add_turn_spring(1);
  ASSERT_TRUE(system->solve(8));
  EXPECT_EQ(system->motion(0).norm(), 0);
}

}  // namespace
}  // namespace pliant
