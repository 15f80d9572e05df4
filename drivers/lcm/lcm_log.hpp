// Reads LCM logs, as lcm-logger writes them. Nothing that a log says is trusted.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

/// One message of a log.
struct LcmLogEvent {
  std::int64_t number = 0, utime = 0;  ///< as the logger counted and stamped it
  std::string channel;
  std::vector<std::uint8_t> body;
};

class LcmLog {
 public:
  static constexpr std::size_t kMaxChannel = 63;                  ///< LCM's own limit
  static constexpr std::size_t kMaxBody = std::size_t{16} << 20;  ///< longer ones are passed over

  /// ErrorKind::bad_input where the file cannot be read or does not begin as a log.
  [[nodiscard]] static Result<LcmLog> open(const std::filesystem::path& file);
  /// The next message, or false at the end. Damaged stretches are passed over and counted. Storage in `event`
  /// is used again.
  [[nodiscard]] bool next(LcmLogEvent& event);
  [[nodiscard]] std::int64_t damages() const noexcept { return damages_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  explicit LcmLog(std::FILE* file) : file_(file) {}
  [[nodiscard]] bool find_begin(bool& damaged);
  /// A stretch is counted once: `damaged` says whether it was.
  void count(bool& damaged);

  std::unique_ptr<std::FILE, Close> file_;
  std::int64_t damages_ = 0;
};

}  // namespace pliant
