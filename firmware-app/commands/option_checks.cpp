#include "firmware-app/commands/option_checks.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <string>

namespace pliant {

namespace {

CLI::Validator names_a(const char* what) {
  return {[what](std::string& value) {
            return value.empty() ? fmt::format("names no {}; name one", what) : std::string();
          },
          ""};
}

/// Whether all of `text` is one T.
template <typename T>
bool read_whole(const std::string& text, T& number) {
  const char* const end = text.data() + text.size();
  const char* const begin = text.starts_with('+') ? text.data() + 1 : text.data();
  const auto [stopped, fault] = std::from_chars(begin, end, number);
  return fault == std::errc() && stopped == end;
}

}  // namespace

CLI::Validator names_a_file() {
  return names_a("file");
}

CLI::Validator names_a_folder() {
  return names_a("folder");
}

CLI::Validator number_within(double low, double high) {
  return {[low, high](std::string& value) {
            double number = 0;
            // False also for what is not a number.
            if (read_whole(value, number) && number >= low && number <= high) return std::string();
            return fmt::format("'{}' is no number from {:g} to {:g}", value, low, high);
          },
          ""};
}

CLI::Validator whole_from_zero() {
  return {[](std::string& value) {
            int number = 0;
            if (read_whole(value, number) && number >= 0) return std::string();
            return fmt::format("'{}' is no whole number from 0 to {}", value,
                               std::numeric_limits<int>::max());
          },
          ""};
}

}  // namespace pliant
