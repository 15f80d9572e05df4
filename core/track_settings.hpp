// Settings of the tracker. The config key is the member's name.
#pragma once

#include <cstdint>

namespace pliant {

/// Which bodies of the integer kernels run. All give the same bits.
enum class Kernels : std::uint8_t { automatic, scalar, sse, avx2, neon };

struct TrackSettings {
  int max_regions = 8;                   ///< rigid regions followed at once, the base included [1, 8]
  double material = 0.5;                 ///< how easily the object stretches: 0 stiff … 1 soft [0, 1]
  Kernels kernels = Kernels::automatic;  ///< bodies of the integer kernels
};

}  // namespace pliant
