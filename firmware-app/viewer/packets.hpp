// What browsers are sent. A packet: its kind and the length of its header (32 bits each, little-endian), the
// header as JSON padded to a multiple of four bytes, arrays padded likewise. page/connection.js reads them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/lcm/frame_assembler.hpp"

namespace pliant::viewer {

/// How the viewer itself hears the tracker.
struct Link {
  std::string url, prefix;
  std::string fault;                ///< why nothing can be heard, with the mend; empty when all is well
  std::vector<std::string> others;  ///< prefixes of other trackers that were heard
  std::int64_t incomplete = 0;      ///< frames and pictures of which a message was lost
  std::string advice;               ///< how fewer are lost; empty where there is nothing to say
};

using Bytes = std::vector<std::uint8_t>;
[[nodiscard]] Bytes link_packet(const Link& link);
[[nodiscard]] Bytes status_packet(const StatusMessage& status);
/// float position[points][3], metres; int8 normal[points][3]
[[nodiscard]] Bytes model_packet(const ReceivedModel& model);
/// int8 label[points]; float {x, y, z, displacement}[deformed], metres; uint16 index[deformed]
[[nodiscard]] Bytes frame_packet(const ReceivedFrame& frame);
/// uint16 reading[rows][columns]: every `step`-th one of every `step`-th row
[[nodiscard]] Bytes depth_packet(const ReceivedDepth& depth);

}  // namespace pliant::viewer
