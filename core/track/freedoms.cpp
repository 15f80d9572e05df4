#include "core/track/freedoms.hpp"

#include <cmath>

#include "core/deform/patch_readings.hpp"
#include "core/geometry/symmetric_eigen6.hpp"
#include "core/track/compare_poses.hpp"

namespace pliant {

namespace {

constexpr int kFree = 2;
/// A motion by one unit changes the readings by this much in the mean square, at the least: as much as one
/// pose must explain them worse than another to count as another.
constexpr double kTold = kAsTwo * kAsTwo;

Matrix6 full(Symmetric6 packed) noexcept {
  Matrix6 m;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column)
      m(row, column) = m(column, row) =
          packed.at(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
  return m;
}

}  // namespace

bool tells_its_motion(const PatchTables& patches, const PatchWarp& warp, const PatchSet& set,
                      const RigidTransform& pose) noexcept {
  Vector3 middle = Vector3::Zero();
  double points = 0, readings = 0, square = 0;
  set.for_each([&](std::size_t p) {
    middle += patches.sizes[p] * (pose * patches.centres[p]);
    points += patches.sizes[p];
    readings += static_cast<double>(warp.moments[p].weight) / 256;
  });
  if (!(readings > 0)) return false;
  middle /= points;
  set.for_each([&](std::size_t p) {
    square += patches.sizes[p] *
              ((pose * patches.centres[p] - middle).squaredNorm() + 0.5 * patches.radius * patches.radius);
  });
  const double arm = std::sqrt(square / points);  // a turn by 1 / arm moves the points by one unit
  Matrix6 all = Matrix6::Zero();
  set.for_each([&](std::size_t p) {
    Symmetric6 own;
    Vector6 unused = Vector6::Zero();
    add_readings(warp.moments[p], own, unused);
    const Vector3 d = pose * patches.centres[p] - middle;
    // turns and shifts of the patch about its centre that the set's about its middle are
    Matrix6 of_patch = Matrix6::Identity();
    of_patch(3, 1) = d.z();
    of_patch(3, 2) = -d.y();
    of_patch(4, 0) = -d.z();
    of_patch(4, 2) = d.x();
    of_patch(5, 0) = d.y();
    of_patch(5, 1) = -d.x();
    of_patch.leftCols<3>() /= arm;
    all += of_patch.transpose() * full(own) * of_patch;
  });
  return symmetric_eigen6(all).values(kFree) >= kTold * readings;
}

}  // namespace pliant
