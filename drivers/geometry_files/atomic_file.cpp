#include "drivers/geometry_files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "drivers/common/write_mend.hpp"

namespace pliant {

AtomicFile::~AtomicFile() {
  abandon();
}

void AtomicFile::abandon() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  descriptor_ = -1;
  if (!direct_) ::unlink(part_);
}

Error AtomicFile::failure(const char* doing, int fault) {
  abandon();
  return {ErrorKind::write, fmt::format("{}: cannot be {}: {}{}", target_, doing,
                                        std::generic_category().message(fault), write_mend(fault))};
}

Outcome AtomicFile::open(const char* path) {
  abandon();
  if (std::snprintf(target_, sizeof target_, "%s", path) >= static_cast<int>(sizeof target_))
    return failure("written", ENAMETOOLONG);
  struct stat about = {};
  if (::lstat(target_, &about) == 0 && S_ISLNK(about.st_mode)) {
    char resolved[PATH_MAX];
    if (::realpath(target_, resolved) != nullptr) std::memcpy(target_, resolved, sizeof target_);
  }
  direct_ = false;
  if (::stat(target_, &about) == 0) {
    if (S_ISDIR(about.st_mode)) return failure("written", EISDIR);
    direct_ = !S_ISREG(about.st_mode);
  }
  if (direct_) {
    descriptor_ = ::open(target_, O_WRONLY | O_CLOEXEC | O_NOCTTY);
  } else {
    if (std::snprintf(part_, sizeof part_, "%s.%ld.part", target_, static_cast<long>(::getpid())) >=
        static_cast<int>(sizeof part_))
      return failure("written", ENAMETOOLONG);
    descriptor_ = ::open(part_, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  }
  if (descriptor_ < 0) return failure("written", errno);
  return success();
}

Outcome AtomicFile::write(std::span<const std::byte> bytes) {
  if (descriptor_ < 0) return failure("written", EBADF);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return failure("written", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return success();
}

Outcome AtomicFile::commit(bool durable) {
  if (descriptor_ < 0) return failure("written", EBADF);
  if (durable && !direct_ && ::fsync(descriptor_) != 0) return failure("written", errno);
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed == 0 && (direct_ || std::rename(part_, target_) == 0)) return success();
  const int fault = errno;
  if (!direct_) ::unlink(part_);
  return failure("put in its place", fault);
}

Outcome write_whole_file(const char* path, std::span<const std::byte> bytes, bool durable) {
  AtomicFile file;
  if (Outcome opened = file.open(path); !opened) return opened;
  if (Outcome written = file.write(bytes); !written) return written;
  return file.commit(durable);
}

}  // namespace pliant
