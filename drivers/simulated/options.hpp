// What may follow `simulated:`.
#pragma once

#include <cstdint>
#include <string_view>

#include "drivers/common/result.hpp"

namespace pliant::simulated {

enum class ObjectKind { cushion, figure, box };

struct Options {
  ObjectKind object = ObjectKind::cushion;
  std::uint32_t seed = 1;     ///< of the noise
  bool noise = true;          ///< noise=structure (the default) or noise=none
  std::int64_t frames = 300;  ///< [1, 10000000]
  int width = 640;            ///< pixels [160, 1280]
  int height = 480;           ///< pixels [120, 960]
};

/// Parses "cushion|figure|box[?key=value[&key=value…]]", with or without "simulated:" before it.
/// ErrorKind::bad_input names what is unknown, with the nearest known word, or out of range.
[[nodiscard]] Result<Options> parse_options(std::string_view text);

}  // namespace pliant::simulated
