// What may follow `simulated:`.
#pragma once

#include <cstdint>
#include <string_view>

#include "drivers/common/result.hpp"

namespace pliant::simulated {

enum class ObjectKind { cushion, figure, box };

/// What happens before the camera.
enum class Motion {
  handled,  ///< the object is moved and deformed
  turned,   ///< the object stands still on the table and is turned once round, and a little more
  circled,  ///< the object rests, the camera goes once round it, and a little more, up and down, near and far
  carried   ///< likewise, in a hand: unsteadily
};

struct Options {
  ObjectKind object = ObjectKind::cushion;
  std::uint32_t seed = 1;           ///< of the noise
  bool noise = true;                ///< noise=structure (the default) or noise=none
  std::int64_t frames = 300;        ///< [1, 10000000]
  int width = 640;                  ///< pixels [160, 1280]
  int height = 480;                 ///< pixels [120, 960]
  Motion motion = Motion::handled;  ///< motion=handled (the default), turned, circled or carried
};

/// Parses "cushion|figure|box[?key=value[&key=value…]]", with or without "simulated:" before it.
/// ErrorKind::bad_input names what is unknown, with the nearest known word, or out of range.
[[nodiscard]] Result<Options> parse_options(std::string_view text);

}  // namespace pliant::simulated
