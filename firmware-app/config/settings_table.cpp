#include "firmware-app/config/settings_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

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

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows of the classic dynamic programme; three are kept for the swaps.
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (same ? 0U : 1U)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(previous);
    previous.swap(row);
  }
  return previous[b.size()];
}

Result<std::string> read_text_file(const std::string& path, std::string_view what) {
  std::error_code ignored;
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxSettingsText + 1, '\0');
  if (!file)
    return Error{ErrorKind::bad_input,
                 fmt::format("cannot read {} {}: {}", what, path, std::generic_category().message(errno))};
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad() || (file.fail() && !file.eof()))
    return Error{ErrorKind::bad_input, fmt::format("cannot read {} {}: not a readable file", what, path)};
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxSettingsText)
    return Error{ErrorKind::bad_input, fmt::format("{} is longer than 1 MB: not a {}", path, what)};
  return text;
}

}  // namespace pliant
