// The path of the base region as a TUM trajectory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/geometry/rigid_transform.hpp"
#include "drivers/common/result.hpp"
#include "drivers/geometry_files/atomic_file.hpp"

namespace pliant {

/// "<seconds> tx ty tz qx qy qz qw" a line, camera <- model, metres; the source's stamp with six decimals.
class TrajectoryWriter {
 public:
  enum class Appears {
    by_lines,    ///< at once, and grows by whole lines: it can be followed, and holds what was written
    when_whole,  ///< by finish(); what was there under its name stays until then
  };
  /// Makes or replaces the file; ErrorKind::write when that cannot be.
  [[nodiscard]] static Result<TrajectoryWriter> create(const std::string& path, Appears appears);
  TrajectoryWriter(TrajectoryWriter&& other) noexcept;
  TrajectoryWriter& operator=(TrajectoryWriter&& other) = delete;
  TrajectoryWriter(const TrajectoryWriter&) = delete;
  TrajectoryWriter& operator=(const TrajectoryWriter&) = delete;
  ~TrajectoryWriter();

  [[nodiscard]] Outcome write(std::int64_t utime, const RigidTransform& pose);
  [[nodiscard]] Outcome write(std::int64_t utime, const Vector3& t, const Quaternion& q);
  /// What the disk could not take shows here at the latest.
  [[nodiscard]] Outcome finish();

 private:
  explicit TrajectoryWriter(const std::string& path) : path_(path) {}
  [[nodiscard]] Error failure(int fault) const;
  [[nodiscard]] Outcome put(std::string_view line);

  std::string path_;
  int descriptor_ = -1;                // by lines
  std::unique_ptr<AtomicFile> whole_;  // when whole
  std::string waiting_;                // for it
};

}  // namespace pliant
