#include "firmware-app/commands/console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace pliant {

namespace {

/// An error stays one line, whatever a file's name holds.
std::string one_line(const std::string& message) {
  std::string line = message;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; },
      ' ');
  return line;
}

}  // namespace

void print_warning(const std::string& message) {
  std::fprintf(stderr, "pliant: %s\n", one_line(message).c_str());
}

int report(const Error& error) {
  print_warning(error.message);
  return exit_code(error.kind);
}

bool print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return true;
  print_warning("cannot write to standard output");
  return false;
}

LiveLine::LiveLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

void LiveLine::show(const std::string& text) {
  if (!terminal_) return;
  winsize size{};
  std::size_t width = 80;
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1) width = size.ws_col;
  std::fprintf(stderr, "\r\033[K%.*s", static_cast<int>(width - 1), text.c_str());
  std::fflush(stderr);
  shown_ = true;
}

void LiveLine::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

}  // namespace pliant
