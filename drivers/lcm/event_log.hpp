// Reads the log files of lcm-logger, event by event.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

struct LoggedEvent {
  std::int64_t received_us = 0;  ///< when the logger took it, microseconds since the epoch
  std::string channel;
  std::vector<std::uint8_t> body;
};

/// Holds one event in memory, whatever the file says. A file cut short ends at its last whole event.
class EventLogReader {
 public:
  /// ErrorKind::bad_input where the file cannot be read or is no LCM log.
  [[nodiscard]] static Result<EventLogReader> open(const std::string& path);

  /// The next event into `event`, whose storage is reused; false at the end.
  [[nodiscard]] bool next(LoggedEvent& event);
  /// Whether bytes after the last whole event could not be read as one.
  [[nodiscard]] bool damaged() const { return damaged_; }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Closer> file_;
  bool damaged_ = false;
};

}  // namespace pliant
