#include "firmware-app/config/settings_table.hpp"

#include <fmt/format.h>

namespace pliant {

namespace {

std::string number_range(const Setting& s, std::string_view noun) {
  std::string text = fmt::format("{} from {:g} to {:g}", noun, s.low, s.high);
  if (!s.unit.empty()) text += fmt::format(" ({})", s.unit);
  return text;
}

}  // namespace

std::string allowed_values(const Setting& s) {
  struct Visitor {
    const Setting& s;
    std::string operator()(const std::string* /*text*/) const {
      return s.low > 0 ? fmt::format("a text of {:g} to {:g} characters in quotes", s.low, s.high)
                       : fmt::format("a text of at most {:g} characters in quotes", s.high);
    }
    std::string operator()(const bool* /*flag*/) const { return "true or false"; }
    std::string operator()(const int* /*number*/) const { return number_range(s, "a whole number"); }
    std::string operator()(const double* /*number*/) const { return number_range(s, "a number"); }
    std::string operator()(const std::optional<double>* /*number*/) const {
      return number_range(s, "a number");
    }
    std::string operator()(const std::vector<int>* /*list*/) const {
      return number_range(s, "a list such as [2, 3] of whole numbers");
    }
  };
  return std::visit(Visitor{s}, s.target);
}

std::string setting_value(const Setting& s) {
  struct Visitor {
    std::string operator()(const std::string* text) const { return fmt::format("\"{}\"", *text); }
    std::string operator()(const bool* flag) const { return *flag ? "true" : "false"; }
    std::string operator()(const int* number) const { return fmt::format("{}", *number); }
    std::string operator()(const double* number) const { return fmt::format("{:g}", *number); }
    std::string operator()(const std::optional<double>* number) const {
      return *number ? fmt::format("{:g}", **number) : "(left out)";
    }
    std::string operator()(const std::vector<int>* list) const {
      return fmt::format("[{}]", fmt::join(*list, ", "));
    }
  };
  return std::visit(Visitor{}, s.target);
}

std::string describe_settings(std::span<const Setting> settings) {
  std::string text;
  for (const Setting& s : settings) {
    const std::string name = s.table.empty() ? std::string(s.key) : fmt::format("{}.{}", s.table, s.key);
    text += fmt::format("{:<22} {:<36} {}: {}\n", name, setting_value(s), s.meaning, allowed_values(s));
  }
  return text;
}

}  // namespace pliant
