// A depth picture as the device delivers it, borrowed from whoever owns it.
#pragma once

#include <cstdint>

namespace pliant {

/// A view of raw depth: `depth[v * stride + u]`, 0 = no reading, in the camera's raw units
/// (Intrinsics::depth_scale per metre).
struct DepthFrame {
  const std::uint16_t* depth = nullptr;
  int width = 0;            ///< pixels
  int height = 0;           ///< pixels
  int stride = 0;           ///< pixels from one row to the next
  std::int64_t utime = 0;   ///< capture time, microseconds
  std::int64_t number = 0;  ///< position in its source, from 0
};

}  // namespace pliant
