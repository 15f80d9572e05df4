// A file for parsers that take a path.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

#include "tests/fuzz/promises.hpp"
#include "tests/fuzz/targets.hpp"

namespace pliant {

/// An anonymous file with these bytes, removed when it is closed.
class ScratchFile {
 public:
  explicit ScratchFile(Bytes data) : file_(std::tmpfile()) {
    promise(file_ != nullptr, "a scratch file can be made");
    promise(std::fwrite(data.data(), 1, data.size(), file_) == data.size(), "it takes the bytes");
    std::rewind(file_);  // and written out
  }
  ~ScratchFile() { std::fclose(file_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  [[nodiscard]] std::FILE* get() const { return file_; }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fileno(file_)); }

 private:
  std::FILE* file_;
};

}  // namespace pliant
