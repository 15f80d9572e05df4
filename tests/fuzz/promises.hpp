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

/// Errors are one printable line that says whose they are.
inline void check_error(const Error& error) {
  promise(error.kind == ErrorKind::bad_input, "a parser's error is a bad input");
  promise(error.message.rfind("file", 0) == 0, "the error names the file");
  promise(error.message.size() < 1000, "the error is short");
  for (const char c : error.message) promise(c != '\n' && c != '\r' && c != '\0', "the error is one line");
}

}  // namespace pliant
