#include "drivers/model_files/symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/detect/symmetric_eigen.hpp"
#include "drivers/model_files/nearest.hpp"

namespace pliant {

namespace {

constexpr std::size_t kPoints = 600;  // looked at; the whole surface is what they are compared with
constexpr double kEqualShare = 0.9;

/// Cosine and sine of a turn's n-th part.
struct Part {
  int of_turn;
  double cosine, sine;
};
constexpr std::array<Part, 4> kParts = {
    {{6, 0.5, 0.8660254037844386}, {4, 0.0, 1.0}, {3, -0.5, 0.8660254037844386}, {2, -1.0, 0.0}}};

Matrix3 turn_about(const Vector3& axis, double cosine, double sine) {
  Matrix3 across;
  across << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return cosine * Matrix3::Identity() + sine * across + (1 - cosine) * axis * axis.transpose();
}

class Comparison {
 public:
  Comparison(const OrientedCloud& cloud, double tolerance)
      : cloud_(cloud),
        tree_(cloud.points),
        tolerance_(tolerance),
        count_(std::min(cloud.points.size(), kPoints)) {
    for (std::size_t i = 0; i < count_; ++i) middle_ += cloud.points[i] / static_cast<double>(count_);
  }
  [[nodiscard]] SymmetricEigen main_axes() const {
    Matrix3 spread = Matrix3::Zero();
    for (std::size_t i = 0; i < count_; ++i) {
      const Vector3 d = cloud_.points[i] - middle_;
      spread += d * d.transpose();
    }
    return symmetric_eigen(spread / std::max(spread.trace(), 1e-300));
  }
  [[nodiscard]] bool same_after(const Matrix3& rotation) const {
    std::size_t off = 0;
    const auto most_off = static_cast<std::size_t>((1 - kEqualShare) * static_cast<double>(count_));
    for (std::size_t i = 0; i < count_; ++i) {
      double square = 0;
      const std::uint32_t j = tree_.nearest(rotation * (cloud_.points[i] - middle_) + middle_, square);
      const bool same =
          square <= tolerance_ * tolerance_ && (rotation * cloud_.normals[i]).dot(cloud_.normals[j]) > 0;
      if (!same && ++off > most_off) return false;
    }
    return true;
  }

 private:
  const OrientedCloud& cloud_;
  NearestPoints tree_;
  double tolerance_;
  std::size_t count_;
  Vector3 middle_ = Vector3::Zero();
};

}  // namespace

std::vector<Symmetry> find_symmetries(const OrientedCloud& cloud, double tolerance) {
  constexpr double kDistinct = 0.03;  // of the spread's trace: closer axes could be any in their plane
  std::vector<Symmetry> found;
  const Comparison comparison(cloud, tolerance);
  const SymmetricEigen axes = comparison.main_axes();
  const auto distinct = [&](int a, int b) { return std::fabs(axes.values(a) - axes.values(b)) > kDistinct; };
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    if (!distinct(a, b) || !distinct(a, c)) continue;
    const Vector3 axis = axes.vectors.col(a);
    for (const Part& part : kParts)
      if (comparison.same_after(turn_about(axis, part.cosine, part.sine))) {
        found.push_back({axis, part.of_turn});
        break;
      }
    if (distinct(b, c)) continue;
    // b and c are any two in their plane: look for the axis of a half turn in steps of 7.5°.
    constexpr double kCosine = 0.9914448613738104, kSine = 0.13052619222005157;
    Vector3 across = axes.vectors.col(b);
    for (int step = 0; step < 24; ++step) {
      if (comparison.same_after(turn_about(across, -1, 0))) {
        found.push_back({across, 2});
        break;
      }
      across = turn_about(axis, kCosine, kSine) * across;
    }
  }
  return found;
}

std::string describe_symmetries(const std::vector<Symmetry>& symmetries) {
  if (symmetries.empty()) return {};
  std::string text = "it looks nearly the same after";
  for (std::size_t i = 0; i < symmetries.size(); ++i) {
    const Symmetry& s = symmetries[i];
    const std::string turn =
        s.parts_of_turn == 2 ? "half a turn" : fmt::format("1/{} of a turn", s.parts_of_turn);
    text += fmt::format("{} {} about ({:.2f} {:.2f} {:.2f})", i == 0 ? "" : ",", turn, s.axis.x(), s.axis.y(),
                        s.axis.z());
  }
  return text + ": it may be found turned so";
}

}  // namespace pliant
