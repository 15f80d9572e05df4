#include "drivers/lcm/lcm_log_writer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "drivers/common/clock.hpp"
#include "drivers/common/write_mend.hpp"
#include "drivers/lcm/wire.hpp"

namespace pliant {

namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes = 28;

Error cannot_write(const std::string& path, int fault) {
  // Of a pipe that nobody reads.
  const std::string mend = fault == ENXIO ? "; start its reader first, or name a file" : write_mend(fault);
  return {ErrorKind::write,
          "LCM log '" + path + "': cannot be written: " + std::generic_category().message(fault) + mend};
}

}  // namespace

Outcome LcmLogWriter::check(const std::string& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) == 0) {
    if (S_ISDIR(about.st_mode)) return cannot_write(path, EISDIR);
    if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) return cannot_write(path, errno);
    return success();
  }
  if (errno != ENOENT) return cannot_write(path, errno);
  std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0) return cannot_write(path, errno);
  return success();
}

Result<std::unique_ptr<LcmLogWriter>> LcmLogWriter::open(const std::string& path, bool append) {
  // Not to wait for the reader of a pipe.
  const int flags =
      O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOCTTY | O_NONBLOCK | (append ? 0 : O_TRUNC);
  const int descriptor = ::open(path.c_str(), flags, 0666);
  if (descriptor < 0) return cannot_write(path, errno);
  struct stat about {};
  const bool regular = ::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
  ::fcntl(descriptor, F_SETFL, O_APPEND);
  return std::unique_ptr<LcmLogWriter>(new LcmLogWriter(path, descriptor, regular));
}

LcmLogWriter::~LcmLogWriter() {
  close();
}

bool LcmLogWriter::failed(int fault) noexcept {
  int none = 0;
  fault_.compare_exchange_strong(none, fault);
  return false;
}

bool LcmLogWriter::write(std::string_view channel, std::span<const std::uint8_t> body) noexcept {
  std::array<std::uint8_t, kHeaderBytes> header{};
  wire::Writer out(header);
  out.put<std::uint32_t>(kSync);
  out.put<std::int64_t>(events_);
  out.put<std::int64_t>(clock_us(CLOCK_REALTIME));
  out.put<std::int32_t>(static_cast<std::int32_t>(channel.size()));
  out.put<std::int32_t>(static_cast<std::int32_t>(body.size()));
  std::array<iovec, 3> parts = {{{header.data(), header.size()},
                                 {const_cast<char*>(channel.data()), channel.size()},
                                 {const_cast<std::uint8_t*>(body.data()), body.size()}}};
  std::size_t written = 0;
  for (std::size_t first = 0; first < parts.size();) {
    if (parts[first].iov_len == 0) {
      ++first;
      continue;
    }
    const ssize_t count = ::writev(descriptor_, &parts[first], static_cast<int>(parts.size() - first));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int fault = errno;
      // Half an event would spoil the next one too.
      struct stat about {};
      if (regular_ && written > 0 && ::fstat(descriptor_, &about) == 0) [[maybe_unused]]
        const int cut = ::ftruncate(descriptor_, about.st_size - static_cast<off_t>(written));
      return failed(fault);
    }
    written += static_cast<std::size_t>(count);
    for (auto left = static_cast<std::size_t>(count); left > 0;) {
      const std::size_t taken = std::min(left, parts[first].iov_len);
      parts[first].iov_base = static_cast<char*>(parts[first].iov_base) + taken;
      parts[first].iov_len -= taken;
      left -= taken;
      if (parts[first].iov_len == 0) ++first;
    }
  }
  ++events_;
  return true;
}

void LcmLogWriter::close() noexcept {
  if (descriptor_ < 0) return;
  if (::close(descriptor_) != 0) failed(errno);
  descriptor_ = -1;
}

Outcome LcmLogWriter::failure() const {
  const int fault = fault_.load();
  return fault == 0 ? success() : Outcome(cannot_write(path_, fault));
}

}  // namespace pliant
