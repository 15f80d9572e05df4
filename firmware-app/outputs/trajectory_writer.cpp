#include "firmware-app/outputs/trajectory_writer.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

namespace pliant {

Result<TrajectoryWriter> TrajectoryWriter::create(const std::string& path) {
  TrajectoryWriter writer;
  writer.path_ = path;
  writer.file_.reset(std::fopen(path.c_str(), "we"));
  if (!writer.file_) return writer.failure();
  return writer;
}

Error TrajectoryWriter::failure() const {
  return {ErrorKind::write, fmt::format("cannot write the trajectory {}: {}", path_, std::strerror(errno))};
}

Outcome TrajectoryWriter::write(std::int64_t utime, const RigidTransform& pose) {
  return write(utime, pose.translation, quaternion_from_rotation(pose.rotation));
}

Outcome TrajectoryWriter::write(std::int64_t utime, const Vector3& t, const Quaternion& q) {
  // A stamp before 1970 keeps its sign and its digits.
  const std::int64_t magnitude = utime < 0 ? -utime : utime;
  const int written =
      std::fprintf(file_.get(), "%s%lld.%06lld %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", utime < 0 ? "-" : "",
                   static_cast<long long>(magnitude / 1'000'000),
                   static_cast<long long>(magnitude % 1'000'000), t.x(), t.y(), t.z(), q.x, q.y, q.z, q.w);
  if (written < 0) return failure();
  return success();
}

Outcome TrajectoryWriter::finish() {
  if (!file_) return success();
  if (std::fflush(file_.get()) != 0) return failure();
  if (std::fclose(file_.release()) != 0) return failure();
  return success();
}

}  // namespace pliant
