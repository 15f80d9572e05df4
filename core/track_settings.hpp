// Settings of the tracker. The config key is the member's name.
#pragma once

#include <cstdint>

namespace pliant {

/// Which bodies of the integer kernels run. All give the same bits.
enum class Kernels : std::uint8_t { automatic, scalar, sse, avx2, neon };

/// Steps that can be left out to see what each is worth. No configuration does.
struct TrackSteps {
  bool input_filter = true;       ///< flying pixels out, readings smoothed up to the edges
  bool temporal_evidence = true;  ///< points change sides after several frames that say so, not after one
  bool merge_and_split = true;    ///< regions come and go; without, the base is the only one
  bool robust_weights = true;     ///< Tukey's; without, every reading within reach weighs the same
};

struct TrackSettings {
  int max_regions = 8;  ///< rigid regions followed at once, the base included [1, 8]
  static constexpr double kAsInModel = -1;
  double material = kAsInModel;  ///< how easily the object stretches: 0 stiff … 1 soft [0, 1], or as
                                 ///< the model says
  Kernels kernels = Kernels::automatic;  ///< bodies of the integer kernels
  TrackSteps steps;
};

}  // namespace pliant
