// From a finished capture to the model file.
#pragma once

#include <string>

#include "core/capture/object_capture.hpp"

namespace pliant {

struct CapturedModelOptions {
  std::string output;    ///< model file
  std::string ply;       ///< mesh file; empty: none
  double clearance = 0;  ///< metres above the table that are cut away
  double sigma = 0;      ///< of the sensor's readings where objects are usually shown, metres
  double material = 0;   ///< 0 stiff … 1 soft [0, 1]
};

/// Cleans the captured surface, writes the files and prints what came out. Where the model's own place cannot
/// be written it is kept beside the temporary files: a capture is not repeated at will. The exit code.
[[nodiscard]] int write_captured_model(const CapturedModelOptions& options, const ObjectCapture& capture,
                                       const JointFit& joint);

}  // namespace pliant
