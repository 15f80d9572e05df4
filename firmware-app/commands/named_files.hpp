// The files that a command's options name: none may be written over what another option needs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

/// Collects what is read and what is written, each with the option that names it ("--stats"), and says
/// whether all of it can be. Empty paths are left out. Devices, pipes and standard output may be named twice.
class NamedFiles {
 public:
  NamedFiles& reads(std::string option, const std::string& path);
  /// The recording's folder, or the file, that a source's URI names; none for devices.
  NamedFiles& reads_source(std::string option, const std::string& uri);
  NamedFiles& writes(std::string option, const std::string& path);
  /// The log that an LCM URL names, read or written as it says; none for networks.
  NamedFiles& uses_log(std::string option, const std::string& lcm_url);
  /// The five tables of `pliant export --csv`.
  NamedFiles& writes_tables(std::string option, const std::string& folder);

  /// ErrorKind::bad_input names both options and the path.
  [[nodiscard]] Outcome apart() const;

 private:
  enum class Use { read, read_folder, write };
  struct Named {
    std::string option, path;
    Use use = Use::read;
    std::filesystem::path place;  // as far as it exists without links, dots and relative parts
  };

  NamedFiles& add(std::string option, const std::string& path, Use use);
  [[nodiscard]] static Outcome apart(const Named& written, const Named& other);

  std::vector<Named> named_;
};

/// How a refusal calls a value that the command line or, for want of it there, the config gives.
[[nodiscard]] std::string option_or_key(bool by_option, std::string_view option, std::string_view key);

}  // namespace pliant
