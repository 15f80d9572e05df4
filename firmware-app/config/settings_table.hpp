// Tables of settings: every key of a TOML file declared once, with its range, unit and meaning.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

/// Where a setting's value lives, in type-erased form; the constructors keep the types right.
using SettingTarget =
    std::variant<std::string*, bool*, int*, double*, std::optional<double>*, std::vector<int>*>;

/// One key. `low` and `high` bound numbers (each one, in a list) and the length of texts.
struct Setting {
  std::string_view table;  ///< "" for the top of the file
  std::string_view key;
  SettingTarget target;
  double low = 0;
  double high = 0;
  std::string_view unit;  ///< "" where there is none
  std::string_view meaning;
};

/// Where a file sets what: "lcm.url" -> "pliant.toml:3:7".
using SettingPlaces = std::map<std::string, std::string, std::less<>>;

/// Longest text that is read, bytes: a config is written by hand.
inline constexpr std::size_t kMaxSettingsText = std::size_t{1} << 20;

/// Reads TOML `text` into the settings' targets. On error (file `name`, line, column, what is allowed)
/// targets may have been written in part: read into a copy. `places` (may be null) is told of each key.
[[nodiscard]] Outcome parse_settings(std::string_view text, std::string_view name,
                                     std::span<const Setting> settings, SettingPlaces* places = nullptr);

/// What a key may hold, in words: "a number from 0 to 1", "true or false".
[[nodiscard]] std::string allowed_values(const Setting& setting);

/// The setting's present value as TOML; "(left out)" where there is none.
[[nodiscard]] std::string setting_value(const Setting& setting);

/// One line a setting: key, value, allowed values, meaning.
[[nodiscard]] std::string describe_settings(std::span<const Setting> settings);

}  // namespace pliant
