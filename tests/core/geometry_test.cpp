#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/geometry/rigid_transform.hpp"
#include "tests/core/synthetic.hpp"

namespace pliant {
namespace {

/// Rotations all over, half turns among them.
class Rotations : public ::testing::Test {
 protected:
  Vector3 vector(double length) {
    Vector3 v;
    do v = Vector3(uniform(), uniform(), uniform());
    while (v.norm() < 0.1);
    return v.normalized() * length;
  }
  double uniform() { return static_cast<double>(random_()) / 2147483648.0 - 1.0; }
  RigidTransform transform() {
    return {synthetic::turn(vector(1), 3.14159 * uniform()), vector(2 * std::fabs(uniform()))};
  }

 private:
  std::mt19937 random_{17};
};

void expect_proper(const Matrix3& r) {
  ASSERT_LT((r.transpose() * r - Matrix3::Identity()).norm(), 1e-12);
  ASSERT_NEAR(r.col(0).cross(r.col(1)).dot(r.col(2)), 1.0, 1e-12);
}

TEST_F(Rotations, FormAGroup) {
  for (int i = 0; i < 500; ++i) {
    const RigidTransform a = transform(), b = transform(), c = transform();
    const Vector3 p = vector(1);
    ASSERT_LT(((a * b) * p - a * (b * p)).norm(), 1e-12);
    ASSERT_LT((((a * b) * c).rotation - (a * (b * c)).rotation).norm(), 1e-12);
    ASSERT_LT((a.inverse() * (a * p) - p).norm(), 1e-12);
    ASSERT_LT(((a * a.inverse()).rotation - Matrix3::Identity()).norm(), 1e-12);
    ASSERT_LT(((a * RigidTransform()) * p - a * p).norm(), 1e-15);
    expect_proper((a * b).rotation);
  }
}

TEST_F(Rotations, OfSmallVectorsAreProperWhateverTheVector) {
  for (const double length : {0.0, 1e-12, 1e-6, 0.01, 0.5, 3.0, 50.0, 1e6})
    for (int i = 0; i < 20; ++i) expect_proper(rotation_from_small_vector(vector(length)));
}

TEST_F(Rotations, OfSmallVectorsFollowTheExponentialToThirdOrder) {
  for (const double angle : {0.001, 0.01, 0.1}) {
    const Vector3 w = vector(angle);
    EXPECT_LT((rotation_from_small_vector(w) - synthetic::turn(w, angle)).norm(), angle * angle * angle);
  }
}

TEST_F(Rotations, ComeBackFromSmallVectors) {
  for (int i = 0; i < 500; ++i) {
    const Matrix3 r = synthetic::turn(vector(1), 3.0 * uniform());
    ASSERT_LT((rotation_from_small_vector(small_vector_from_rotation(r)) - r).norm(), 1e-9);
    const Vector3 w = vector(std::fabs(uniform()));
    ASSERT_LT((small_vector_from_rotation(rotation_from_small_vector(w)) - w).norm(), 1e-12);
  }
}

TEST_F(Rotations, ComeBackFromQuaternions) {
  for (int i = 0; i < 1000; ++i) {
    const double angle = i % 4 == 0 ? 3.14159265358979 : 3.14159 * uniform();  // half turns, too
    const Matrix3 r =
        synthetic::turn(i % 8 == 0 ? Vector3(i % 3 == 0, i % 3 == 1, i % 3 == 2) : vector(1), angle);
    const Quaternion q = quaternion_from_rotation(r);
    ASSERT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1.0, 1e-12);
    ASSERT_GE(q.w, 0.0);
    ASSERT_LT((rotation_from_quaternion(q) - r).norm(), 1e-7);
  }
}

TEST_F(Rotations, AreMadeProperAgain) {
  for (int i = 0; i < 200; ++i) {
    const Matrix3 r = transform().rotation;
    Matrix3 off = r;
    for (int k = 0; k < 9; ++k) off(k / 3, k % 3) += 0.01 * uniform();
    const Matrix3 mended = orthonormalised(off);
    expect_proper(mended);
    ASSERT_LT((mended - r).norm(), 0.05);
  }
}

TEST_F(Rotations, TellTheirAngle) {
  for (const double angle : {0.0, 0.3, 1.5, 3.0})
    EXPECT_NEAR(cos_angle(synthetic::turn(vector(1), angle)), std::cos(angle), 1e-12);
}

}  // namespace
}  // namespace pliant
