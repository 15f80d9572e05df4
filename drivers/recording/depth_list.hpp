// depth.txt: the frames of a recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

/// Whether a list can hold this stamp, microseconds: 0 to 10^10 s.
[[nodiscard]] constexpr bool is_listable(std::int64_t utime) noexcept {
  constexpr std::int64_t kMost = 10'000'000'000'000'000;
  return utime >= 0 && utime <= kMost;
}

struct DepthListEntry {
  std::int64_t utime = 0;  ///< microseconds
  std::string file;        ///< relative to the recording's folder, inside it
};

/// Parses the text of a depth.txt: "<seconds> <file>" a line, `#` begins a comment line, blank lines and CRLF
/// are allowed. `folder` is the recording's own: an absolute path is taken if it lies in it. `name` stands in
/// the errors. ErrorKind::bad_input with the line's number: not two fields, a stamp that is no number or not
/// within 0 to 10^10 s, a file outside the folder; or no frame listed at all.
[[nodiscard]] Result<std::vector<DepthListEntry>> parse_depth_list(std::string_view text,
                                                                   std::string_view name,
                                                                   const std::filesystem::path& folder);
/// Reads and parses `folder`/depth.txt.
[[nodiscard]] Result<std::vector<DepthListEntry>> read_depth_list(const std::filesystem::path& folder);

}  // namespace pliant
