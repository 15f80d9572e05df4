#include "drivers/simulated/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "drivers/common/nearest_word.hpp"

namespace pliant::simulated {

namespace {

constexpr std::array<std::string_view, 3> kObjects{"cushion", "figure", "box"};
constexpr std::array<std::string_view, 6> kKeys{"seed", "noise", "frames", "width", "height", "motion"};
constexpr std::array<std::string_view, 2> kNoises{"structure", "none"};
constexpr std::array<std::string_view, 4> kMotions{"handled", "turned", "circled", "carried"};
constexpr std::size_t kShown = 60;  ///< characters of a wrong word that an error repeats

Error bad(std::string what) {
  return {ErrorKind::bad_input, fmt::format("simulated: {}", what)};
}

Error unknown(std::string_view kind, std::string_view word, std::span<const std::string_view> known) {
  return bad(fmt::format("unknown {} '{}'; nearest known is '{}' of {}", kind, word.substr(0, kShown),
                         nearest_word(word, known), fmt::join(known, ", ")));
}

template <typename Number>
Outcome read(std::string_view key, std::string_view value, Number low, Number high, Number& to) {
  std::int64_t number = 0;
  const auto parsed = std::from_chars(value.data(), value.data() + value.size(), number);
  const bool whole = parsed.ec == std::errc() && parsed.ptr == value.data() + value.size() && !value.empty();
  if (!whole || number < static_cast<std::int64_t>(low) || number > static_cast<std::int64_t>(high))
    return bad(
        fmt::format("{}={} must be a whole number from {} to {}", key, value.substr(0, kShown), low, high));
  to = static_cast<Number>(number);
  return success();
}

Outcome set(std::string_view key, std::string_view value, Options& options) {
  if (key == "seed") return read<std::uint32_t>(key, value, 0, 0xffffffff, options.seed);
  if (key == "frames") return read<std::int64_t>(key, value, 1, 10000000, options.frames);
  if (key == "width") return read<int>(key, value, 160, 1280, options.width);
  if (key == "height") return read<int>(key, value, 120, 960, options.height);
  if (key == "motion") {
    const auto* const motion = std::find(kMotions.begin(), kMotions.end(), value);
    if (motion == kMotions.end()) return unknown("motion", value, kMotions);
    options.motion = static_cast<Motion>(motion - kMotions.begin());
    return success();
  }
  if (key != "noise") return unknown("key", key, kKeys);
  if (std::find(kNoises.begin(), kNoises.end(), value) == kNoises.end())
    return unknown("noise", value, kNoises);
  options.noise = value == "structure";
  return success();
}

}  // namespace

Result<Options> parse_options(std::string_view text) {
  constexpr std::string_view kScheme = "simulated:";
  if (text.substr(0, kScheme.size()) == kScheme) text.remove_prefix(kScheme.size());
  const std::size_t end = std::min(text.find('?'), text.size());
  const std::string_view object = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));

  Options options;
  const auto* const found = std::find(kObjects.begin(), kObjects.end(), object);
  if (found == kObjects.end()) return unknown("object", object, kObjects);
  options.object = static_cast<ObjectKind>(found - kObjects.begin());
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(pair.size() + 1, text.size()));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos)
      return bad(fmt::format("'{}' must be key=value", pair.substr(0, kShown)));
    if (Outcome done = set(pair.substr(0, equals), pair.substr(equals + 1), options); !done)
      return done.error();
  }
  return options;
}

}  // namespace pliant::simulated
