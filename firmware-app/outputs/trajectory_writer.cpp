#include "firmware-app/outputs/trajectory_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <span>
#include <system_error>
#include <utility>

#include "drivers/common/write_mend.hpp"

namespace pliant {

namespace {

constexpr std::size_t kAtOnce = 1U << 16;

}  // namespace

Result<TrajectoryWriter> TrajectoryWriter::create(const std::string& path, Appears appears) {
  TrajectoryWriter writer(path);
  if (appears == Appears::when_whole) {
    writer.whole_ = std::make_unique<AtomicFile>();
    if (Outcome opened = writer.whole_->open(path.c_str()); !opened) return opened.error();
    return writer;
  }
  writer.descriptor_ =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC | O_NOCTTY, 0666);
  if (writer.descriptor_ < 0) return writer.failure(errno);
  return writer;
}

TrajectoryWriter::TrajectoryWriter(TrajectoryWriter&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      whole_(std::move(other.whole_)),
      waiting_(std::move(other.waiting_)) {}

TrajectoryWriter::~TrajectoryWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Error TrajectoryWriter::failure(int fault) const {
  return {ErrorKind::write, fmt::format("cannot write the trajectory {}: {}{}", path_,
                                        std::generic_category().message(fault), write_mend(fault))};
}

Outcome TrajectoryWriter::write(std::int64_t utime, const RigidTransform& pose) {
  return write(utime, pose.translation, quaternion_from_rotation(pose.rotation));
}

Outcome TrajectoryWriter::write(std::int64_t utime, const Vector3& t, const Quaternion& q) {
  // A stamp before 1970 keeps its sign and its digits.
  const std::int64_t magnitude = utime < 0 ? -utime : utime;
  std::array<char, 256> line{};
  const int length =
      std::snprintf(line.data(), line.size(), "%s%lld.%06lld %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n",
                    utime < 0 ? "-" : "", static_cast<long long>(magnitude / 1'000'000),
                    static_cast<long long>(magnitude % 1'000'000), t.x(), t.y(), t.z(), q.x, q.y, q.z, q.w);
  return put({line.data(), static_cast<std::size_t>(length)});
}

Outcome TrajectoryWriter::put(std::string_view line) {
  if (whole_ != nullptr) {
    waiting_ += line;
    if (waiting_.size() < kAtOnce) return success();
    Outcome written = whole_->write(std::as_bytes(std::span(waiting_)));
    waiting_.clear();
    return written;
  }
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t count = ::write(descriptor_, line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int fault = errno;
      // The file ends with the last whole line.
      struct stat about {};
      if (written > 0 && ::fstat(descriptor_, &about) == 0 && S_ISREG(about.st_mode)) [[maybe_unused]]
        const int cut = ::ftruncate(descriptor_, about.st_size - static_cast<off_t>(written));
      return failure(fault);
    }
    written += static_cast<std::size_t>(count);
  }
  return success();
}

Outcome TrajectoryWriter::finish() {
  if (whole_ != nullptr) {
    if (Outcome written = whole_->write(std::as_bytes(std::span(waiting_))); !written) return written;
    return whole_->commit(false);
  }
  if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0) return failure(errno);
  return success();
}

}  // namespace pliant
