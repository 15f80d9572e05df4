// A file that appears under its name only once it is whole.
#pragma once

#include <climits>
#include <cstddef>
#include <span>

#include "drivers/common/result.hpp"

namespace pliant {

/// Writes to "<path>.<process>.part" beside the target and renames it when committed; what is not committed
/// is removed. Where the target exists and is no regular file (a pipe, a device), it is written to directly.
/// No heap call unless something fails. Every failure is an ErrorKind::write.
class AtomicFile {
 public:
  AtomicFile() = default;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  [[nodiscard]] Outcome open(const char* path);
  [[nodiscard]] Outcome write(std::span<const std::byte> bytes);
  /// `durable`: the bytes are on the disk, not only with the kernel, before the name is.
  [[nodiscard]] Outcome commit(bool durable);

 private:
  [[nodiscard]] Error failure(const char* doing, int fault);
  void abandon();

  int descriptor_ = -1;
  bool direct_ = false;
  char target_[PATH_MAX] = {};
  char part_[PATH_MAX] = {};
};

/// Writes all of `bytes` to `path` by way of an AtomicFile.
[[nodiscard]] Outcome write_whole_file(const char* path, std::span<const std::byte> bytes, bool durable);

}  // namespace pliant
