// Reading TOML into a table of settings.
#include <fmt/format.h>

#include <limits>

#include "drivers/common/nearest_word.hpp"
#include "drivers/common/printable.hpp"
#include "drivers/common/toml_text.hpp"
#include "firmware-app/config/settings_table.hpp"

namespace pliant {

namespace {

std::string full_name(std::string_view table, std::string_view key) {
  return table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

Error error_at(std::string_view name, const toml::source_region& where, const std::string& what) {
  return {ErrorKind::bad_input,
          fmt::format("{}:{}:{}: {}", name, where.begin.line, where.begin.column, what)};
}

const Setting& nearest(std::span<const Setting> settings, std::string_view table, std::string_view key) {
  const Setting* best = settings.data();
  key = key.substr(0, 64);  // a longer one is no slip of the pen
  table = table.substr(0, 64);
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const Setting& s : settings) {
    // A key in the wrong table costs one edit, so that a right name in a wrong place is found.
    const std::size_t whole = edit_distance(full_name(table, key), full_name(s.table, s.key));
    const std::size_t leaf = edit_distance(key, s.key) + (table == s.table ? 0U : 1U);
    if (std::min(whole, leaf) < least) {
      least = std::min(whole, leaf);
      best = &s;
    }
  }
  return *best;
}

/// Writes the node's value; false when it has the wrong type or is out of range.
struct Assign {
  const toml::node& node;
  const Setting& setting;

  [[nodiscard]] bool within(double x) const { return x >= setting.low && x <= setting.high; }

  [[nodiscard]] static bool whole(const toml::node& from, const Assign& limits, int& to) {
    const toml::value<std::int64_t>* integer = from.as_integer();
    if (integer == nullptr || !limits.within(static_cast<double>(integer->get()))) return false;
    to = static_cast<int>(integer->get());
    return true;
  }
  bool operator()(std::string* to) const {
    const toml::value<std::string>* text = node.as_string();
    if (text == nullptr || !within(static_cast<double>(text->get().size()))) return false;
    *to = text->get();
    return to->find('\0') == std::string::npos;
  }
  bool operator()(bool* to) const {
    const toml::value<bool>* flag = node.as_boolean();
    if (flag == nullptr) return false;
    *to = flag->get();
    return true;
  }
  bool operator()(int* to) const { return whole(node, *this, *to); }
  bool operator()(double* to) const {
    double x = 0;
    if (const auto* real = node.as_floating_point(); real != nullptr)
      x = real->get();
    else if (const auto* integer = node.as_integer(); integer != nullptr)
      x = static_cast<double>(integer->get());
    else
      return false;
    if (!within(x)) return false;  // neither is a NaN
    *to = x;
    return true;
  }
  bool operator()(std::optional<double>* to) const {
    double x = 0;
    if (!(*this)(&x)) return false;
    *to = x;
    return true;
  }
  bool operator()(std::vector<int>* to) const {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() > 64) return false;
    std::vector<int> values;
    for (const toml::node& item : *list) {
      values.push_back(0);
      if (!whole(item, *this, values.back())) return false;
    }
    *to = std::move(values);
    return true;
  }
};

Outcome assign(const toml::node& node, const toml::source_region& where, std::string_view name,
               std::string_view table, std::string_view key, std::span<const Setting> settings,
               SettingPlaces* places) {
  for (const Setting& s : settings)
    if (s.table == table && s.key == key) {
      if (std::visit(Assign{node, s}, s.target)) {
        const toml::source_position& begin = node.source().begin;
        if (places != nullptr)
          (*places)[full_name(table, key)] = fmt::format("{}:{}:{}", name, begin.line, begin.column);
        return success();
      }
      return error_at(name, node.source(),
                      fmt::format("{} must be {}", full_name(table, key), allowed_values(s)));
    }
  const Setting& guess = nearest(settings, table, key);
  return error_at(name, where,
                  fmt::format("unknown key '{}'; the nearest known one is '{}'",
                              printable(full_name(table, key)), full_name(guess.table, guess.key)));
}

}  // namespace

Outcome parse_settings(std::string_view text, std::string_view name, std::span<const Setting> settings,
                       SettingPlaces* places) {
  if (text.size() > kMaxSettingsText)
    return Error{ErrorKind::bad_input, fmt::format("{} is longer than 1 MB", name)};
  const Result<toml::table> parsed = parse_toml(text, name);
  if (!parsed) return parsed.error();

  for (const auto& [key, node] : *parsed) {
    bool is_table = false;
    for (const Setting& s : settings) is_table = is_table || (!s.table.empty() && s.table == key.str());
    if (!is_table || node.as_table() == nullptr) {
      if (is_table)
        return error_at(
            name, node.source(),
            fmt::format("'{}' must be a table, written [{}]", printable(key.str()), printable(key.str())));
      if (Outcome done = assign(node, key.source(), name, "", key.str(), settings, places); !done)
        return done;
      continue;
    }
    for (const auto& [inner, value] : *node.as_table())
      if (Outcome done = assign(value, inner.source(), name, key.str(), inner.str(), settings, places); !done)
        return done;
  }
  return success();
}

}  // namespace pliant
