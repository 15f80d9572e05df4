#include "core/track/plane_equations.hpp"

namespace pliant {

PlaneEquations plane_equations(const PlaneMoments& moments) noexcept {
  Vector6 unit;
  unit << 1 / kUnitsPerMetre, 1 / kUnitsPerMetre, 1 / kUnitsPerMetre, 1 / 16384.0, 1 / 16384.0, 1 / 16384.0;
  constexpr double kWeight = 1 / 256.0;
  PlaneEquations equations;
  std::size_t k = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) {
      equations.a(row, column) = static_cast<double>(moments.a[k++]) * unit[row] * unit[column];
      equations.a(column, row) = equations.a(row, column);
    }
  equations.a = equations.a * kWeight;
  for (int i = 0; i < 6; ++i)
    equations.b[i] =
        static_cast<double>(moments.b[static_cast<std::size_t>(i)]) * unit[i] * kWeight * kResidualMetres;
  return equations;
}

}  // namespace pliant
