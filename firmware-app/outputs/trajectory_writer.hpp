// The path of the base region as a TUM trajectory.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "core/geometry/rigid_transform.hpp"
#include "drivers/common/result.hpp"

namespace pliant {

/// "<seconds> tx ty tz qx qy qz qw" a line, camera <- model, metres; the source's stamp with six decimals.
class TrajectoryWriter {
 public:
  /// Makes or replaces the file; ErrorKind::write when that cannot be.
  [[nodiscard]] static Result<TrajectoryWriter> create(const std::string& path);

  [[nodiscard]] Outcome write(std::int64_t utime, const RigidTransform& pose);
  [[nodiscard]] Outcome write(std::int64_t utime, const Vector3& t, const Quaternion& q);
  /// What the disk could not take shows here at the latest.
  [[nodiscard]] Outcome finish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[nodiscard]] Error failure() const;

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace pliant
