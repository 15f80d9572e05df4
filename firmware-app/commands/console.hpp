// What the program says, and how it ends.
#pragma once

#include <string>

#include "drivers/common/result.hpp"

namespace pliant {

/// Exit codes, as the manual states them.
inline constexpr int kExitDone = 0;
inline constexpr int kExitNotFound = 1;
inline constexpr int kExitBadInput = 2;
inline constexpr int kExitFailed = 3;

[[nodiscard]] constexpr int exit_code(ErrorKind kind) {
  return kind == ErrorKind::bad_input ? kExitBadInput : kExitFailed;
}

/// One line on stderr, "pliant: ...".
void print_warning(const std::string& message);
/// The same; the exit code that the error stands for.
[[nodiscard]] int report(const Error& error);
/// Text on stdout. False, with one line on stderr, when it could not be written (a full disk, a closed pipe).
[[nodiscard]] bool print(const std::string& text);

/// One line on stderr that is written over and over; nothing where stderr is no terminal.
class LiveLine {
 public:
  LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;
  ~LiveLine() { clear(); }
  void show(const std::string& text);
  void clear();
  [[nodiscard]] bool active() const { return terminal_; }

 private:
  bool terminal_ = false;
  bool shown_ = false;
};

}  // namespace pliant
