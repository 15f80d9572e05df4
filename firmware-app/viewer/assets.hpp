// The page's files, inside the program.
#pragma once

#include <span>
#include <string_view>

namespace pliant::viewer {

struct Asset {
  std::string_view path;  ///< "/main.js"
  std::string_view type;  ///< MIME type
  bool gzip = false;      ///< packed
  std::string_view bytes;
};

[[nodiscard]] std::span<const Asset> assets();

}  // namespace pliant::viewer
