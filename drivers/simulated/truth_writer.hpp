// Writes the truth of a simulated recording beside it.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/common/result.hpp"
#include "drivers/simulated/simulated.hpp"

namespace pliant {

/// Into the folder of a recording:
/// - `model.ply`: the object at rest, binary little-endian PLY (x y z nx ny nz, triangles), metres.
/// - `truth/NNNNNN.ply` per frame: binary little-endian PLY, one vertex per vertex of model.ply in its order:
///   `float x y z` in the camera's frame, `uchar visible`, `char part` (-1 = deforms).
/// - `truth/poses.txt`: "<seconds> <frame> <present 0|1> <part> tx ty tz qx qy qz qw" per frame and rigid
/// part,
///   camera <- model, # comments.
/// NNNNNN is the frame's position in the recording, as RecordingWriter counts. The base's pose also belongs
/// in groundtruth.txt, which is RecordingWriter's. Every file is whole after each call.
class TruthWriter {
 public:
  /// `folder` must exist. ErrorKind::write with the file and the system's reason.
  [[nodiscard]] static Result<std::unique_ptr<TruthWriter>> create(const std::filesystem::path& folder,
                                                                   const Geometry& mesh);
  /// Writes what is true of the frame that became frame `position` of the recording.
  [[nodiscard]] Outcome write(std::int64_t position, const SimulatedTruth& truth);
  [[nodiscard]] Outcome finish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  explicit TruthWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::filesystem::path folder_;
  std::unique_ptr<std::FILE, Close> poses_;
  std::vector<std::byte> bytes_;
};

}  // namespace pliant
