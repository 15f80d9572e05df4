#include "drivers/recording/depth_list.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "drivers/common/printable.hpp"
#include "drivers/recording/text_file.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{256} << 20;
constexpr std::size_t kMaxPath = 4096;
constexpr double kMaxSeconds = 1e10;

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// The next field of `line`, cut off its front; empty at its end.
std::string_view next_field(std::string_view& line) {
  while (!line.empty() && blank(line.front())) line.remove_prefix(1);
  std::size_t length = 0;
  while (length < line.size() && !blank(line[length])) ++length;
  const std::string_view field = line.substr(0, length);
  line.remove_prefix(length);
  return field;
}

/// The path relative to the folder, or empty when it leads out of it.
std::string inside(std::string_view field, const std::filesystem::path& folder) {
  std::filesystem::path path = std::filesystem::path(field).lexically_normal();
  if (path.is_absolute()) {
    std::error_code ignored;
    path = path.lexically_relative(std::filesystem::absolute(folder, ignored).lexically_normal());
  }
  if (path.empty() || *path.begin() == ".." || *path.begin() == "." || !path.has_filename()) return {};
  return path.string();
}

}  // namespace

Result<std::vector<DepthListEntry>> parse_depth_list(std::string_view text, std::string_view name,
                                                     const std::filesystem::path& folder) {
  std::vector<DepthListEntry> entries;
  std::size_t number = 0;
  const auto bad = [&](std::string_view what) {
    return Error{ErrorKind::bad_input, fmt::format("{}:{}: {}", name, number, what)};
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    const std::string_view stamp = next_field(line);
    if (stamp.empty() || stamp.front() == '#') continue;
    const std::string_view file = next_field(line);
    if (file.empty() || !next_field(line).empty())
      return bad("a line must be '<seconds> <file>', for example '0.033333 depth/000001.png'");
    double seconds = 0;
    const auto parsed = std::from_chars(stamp.data(), stamp.data() + stamp.size(), seconds);
    if (parsed.ec != std::errc() || parsed.ptr != stamp.data() + stamp.size())
      return bad(fmt::format("'{}' is not a number of seconds", printable(stamp, 40)));
    if (!(seconds >= 0 && seconds <= kMaxSeconds))
      return bad(fmt::format("stamp {} is not within 0 to 1e10 seconds", printable(stamp, 40)));
    if (file.size() > kMaxPath || file.find('\0') != std::string_view::npos)
      return bad("the file's name is unusable");
    std::string relative = inside(file, folder);
    if (relative.empty())
      return bad(fmt::format("'{}' is not a file inside the recording", printable(file, 200)));
    entries.push_back({std::llround(seconds * 1e6), std::move(relative)});
  }
  if (entries.empty()) return Error{ErrorKind::bad_input, fmt::format("{}: lists no frame", name)};
  return entries;
}

Result<std::vector<DepthListEntry>> read_depth_list(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "depth.txt";
  const Result<std::string> text = read_text_file(file, kMaxBytes);
  if (!text) return text.error();
  return parse_depth_list(*text, file.string(), folder);
}

}  // namespace pliant
