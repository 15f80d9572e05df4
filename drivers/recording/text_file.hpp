// Reads a whole text file with a bound on its size.
#pragma once

#include <fmt/core.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include "drivers/common/result.hpp"

namespace pliant {

/// The file's content; ErrorKind::bad_input with the file and the system's reason, or when it is larger than
/// `most` bytes.
inline Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t most) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!in) return Error{ErrorKind::bad_input, fmt::format("{}: {}", file.string(), std::strerror(errno))};
  std::string text;
  char part[4096];
  for (;;) {
    errno = 0;
    const std::size_t got = std::fread(part, 1, sizeof part, in.get());
    if (std::ferror(in.get()) != 0)
      return Error{ErrorKind::bad_input, fmt::format("{}: {}", file.string(), std::strerror(errno))};
    text.append(part, got);
    if (got < sizeof part) return text;
    if (text.size() > most)
      return Error{ErrorKind::bad_input, fmt::format("{}: larger than {} MB", file.string(), most >> 20)};
  }
}

}  // namespace pliant
