// Checks of options' values that CLI11 has not, or has with holes.
#pragma once

#include <CLI/CLI.hpp>

namespace pliant {

/// An option that names a file or a folder and holds nothing, as an unset variable of a shell leaves it, is
/// refused: it would count as left out.
[[nodiscard]] CLI::Validator names_a_file();
[[nodiscard]] CLI::Validator names_a_folder();

/// A finite number from `low` to `high`. (CLI::Range lets through what is not a number.)
[[nodiscard]] CLI::Validator number_within(double low, double high);

/// A whole number from 0.
[[nodiscard]] CLI::Validator whole_from_zero();

}  // namespace pliant
