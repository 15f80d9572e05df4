#include "firmware-app/commands/named_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "drivers/lcm/lcm_url.hpp"

namespace pliant {

namespace {

namespace fs = std::filesystem;

fs::path place_of(const std::string& path) {
  std::error_code fault;
  const fs::path whole = fs::absolute(path, fault);
  fs::path place = fs::weakly_canonical(whole, fault);
  if (fault) place = whole.lexically_normal();
  return place.has_filename() ? place : place.parent_path();  // without a slash at its end
}

/// What takes all that is written to it. Standard output is one whatever it leads to.
bool is_stream(const std::string& path) {
  const std::string spelled = fs::path(path).lexically_normal().string();
  for (const std::string_view name : {"/dev/stdout", "/dev/stderr", "/dev/fd/", "/proc/self/fd/"})
    if (spelled.starts_with(name)) return true;
  std::error_code fault;
  const fs::file_status about = fs::status(path, fault);
  return fs::exists(about) && !fs::is_regular_file(about) && !fs::is_directory(about);
}

bool is_inside(const fs::path& place, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), place.begin(), place.end()).first == folder.end();
}

}  // namespace

NamedFiles& NamedFiles::add(std::string option, const std::string& path, Use use) {
  if (!path.empty() && !is_stream(path)) named_.push_back({std::move(option), path, use, place_of(path)});
  return *this;
}

NamedFiles& NamedFiles::reads(std::string option, const std::string& path) {
  return add(std::move(option), path, Use::read);
}

NamedFiles& NamedFiles::reads_source(std::string option, const std::string& uri) {
  for (const auto& [scheme, use] : {std::pair{std::string_view("recording:"), Use::read_folder},
                                    {"oni:", Use::read},
                                    {"lcmlog:", Use::read}})
    if (uri.starts_with(scheme)) return add(std::move(option), uri.substr(scheme.size()), use);
  return *this;
}

NamedFiles& NamedFiles::writes(std::string option, const std::string& path) {
  return add(std::move(option), path, Use::write);
}

NamedFiles& NamedFiles::uses_log(std::string option, const std::string& lcm_url) {
  const Result<LcmUrl> url = LcmUrl::parse(lcm_url);
  if (!url || url->provider != LcmUrl::Provider::log_file) return *this;
  return add(std::move(option), url->path, url->writes ? Use::write : Use::read);
}

NamedFiles& NamedFiles::writes_tables(std::string option, const std::string& folder) {
  if (folder.empty()) return *this;
  for (const char* name : {"frames.csv", "regions.csv", "deformed.csv", "status.csv", "stages.csv"})
    add(option, (fs::path(folder) / name).string(), Use::write);
  return add(std::move(option), folder, Use::write);
}

Outcome NamedFiles::apart(const Named& written, const Named& other) {
  std::error_code fault;
  if (written.place == other.place || fs::equivalent(written.path, other.path, fault)) {
    if (other.use == Use::write)
      return Error{ErrorKind::bad_input, fmt::format("{} and {} both write {}; name two different files",
                                                     written.option, other.option, written.path)};
    return Error{ErrorKind::bad_input,
                 fmt::format("{} would write over {}, which {} names; name another file", written.option,
                             written.path, other.option)};
  }
  if (other.use == Use::read_folder && is_inside(written.place, other.place) &&
      fs::exists(written.path, fault) && !fs::is_directory(written.path, fault))
    return Error{
        ErrorKind::bad_input,
        fmt::format("{} would write over {}, which is in the recording that {} names; name another file",
                    written.option, written.path, other.option)};
  return success();
}

Outcome NamedFiles::apart() const {
  for (std::size_t i = 0; i < named_.size(); ++i)
    for (std::size_t j = 0; j < named_.size(); ++j) {
      const Named &written = named_[i], &other = named_[j];
      // Of two that are written the first is looked at from the second's side too: once is enough.
      if (written.use != Use::write || (other.use == Use::write && j <= i)) continue;
      if (written.option == other.option) continue;
      if (Outcome well = apart(written, other); !well) return well;
    }
  return success();
}

std::string option_or_key(bool by_option, std::string_view option, std::string_view key) {
  return by_option ? std::string(option) : fmt::format("'{}' in the config", key);
}

}  // namespace pliant
