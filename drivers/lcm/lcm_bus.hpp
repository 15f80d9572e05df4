// One connection to LCM. Several publishers and subscribers of a process may share it.
#pragma once

#include <lcm/lcm.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "drivers/common/result.hpp"
#include "drivers/lcm/lcm_log_writer.hpp"
#include "drivers/lcm/lcm_url.hpp"

namespace pliant {

class LcmBus {
 public:
  /// Bad URLs are ErrorKind::bad_input, a network that is not there ErrorKind::device with the commands that
  /// mend it, a log file that cannot be written ErrorKind::write.
  [[nodiscard]] static Result<std::shared_ptr<LcmBus>> open(std::string_view url);
  [[nodiscard]] static Result<std::shared_ptr<LcmBus>> open(const LcmUrl& url);
  ~LcmBus();
  LcmBus(const LcmBus&) = delete;
  LcmBus& operator=(const LcmBus&) = delete;

  /// Null where the URL is that of a log to be written: LCM's own writer does not tell when that fails.
  [[nodiscard]] lcm_t* get() const noexcept { return lcm_; }
  /// False when it was not sent or written. `channel` ends with a zero. One thread calls it.
  [[nodiscard]] bool publish(const std::string& channel, std::span<const std::uint8_t> body) noexcept;
  /// Ends a log that is written; nothing may be published after.
  void close_log() noexcept;
  /// What of a log could not be written, first of all.
  [[nodiscard]] Outcome log_failure() const;
  [[nodiscard]] const LcmUrl& url() const noexcept { return url_; }

 private:
  LcmBus(LcmUrl url, lcm_t* lcm, std::unique_ptr<LcmLogWriter> log);
  LcmUrl url_;
  lcm_t* lcm_;
  std::unique_ptr<LcmLogWriter> log_;
};

}  // namespace pliant
