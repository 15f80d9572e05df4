// Writes LCM logs, as lcm-logger does. LCM's own writer does not tell when the disk is full.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "drivers/common/result.hpp"

namespace pliant {

/// One thread writes; failure() is for any.
class LcmLogWriter {
 public:
  /// Whether open() would succeed, as far as can be told without touching the file.
  [[nodiscard]] static Outcome check(const std::string& path);
  /// `append`: what the file holds stays. Errors are one line with the file's name and the mend.
  [[nodiscard]] static Result<std::unique_ptr<LcmLogWriter>> open(const std::string& path, bool append);
  LcmLogWriter(const LcmLogWriter&) = delete;
  LcmLogWriter& operator=(const LcmLogWriter&) = delete;
  ~LcmLogWriter();

  /// Writes one event, stamped with the time now. False when that failed; a regular file then ends with the
  /// event before, and the next call tries again. No heap call, no buffer: what was written is in the file.
  [[nodiscard]] bool write(std::string_view channel, std::span<const std::uint8_t> body) noexcept;
  /// Some disks tell only here that they could not take it all.
  void close() noexcept;
  /// The first failure so far.
  [[nodiscard]] Outcome failure() const;

 private:
  LcmLogWriter(std::string path, int descriptor, bool regular)
      : path_(std::move(path)), descriptor_(descriptor), regular_(regular) {}
  bool failed(int fault) noexcept;

  std::string path_;
  int descriptor_;
  bool regular_;
  std::int64_t events_ = 0;
  std::atomic<int> fault_{0};
};

}  // namespace pliant
