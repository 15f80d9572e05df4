// Checks that end the program.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "drivers/common/result.hpp"

namespace pliant {

inline void promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

/// What is told is one line that can be read.
inline void check_line(const std::string& text) {
  promise(!text.empty() && text.size() < 2000, "a fault is told, shortly");
  for (const char c : text) promise(c != '\n' && c != '\r' && c != '\0', "in one line");
}

/// Errors are one printable line that says whose they are.
inline void check_error(const Error& error) {
  promise(error.kind == ErrorKind::bad_input, "a parser's error is a bad input");
  promise(error.message.rfind("file", 0) == 0, "the error names the file");
  check_line(error.message);
}

}  // namespace pliant
