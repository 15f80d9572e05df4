#include "drivers/geometry_files/output_place.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "drivers/geometry_files/atomic_file.hpp"

namespace pliant {

namespace {

double megabytes(std::uintmax_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

}  // namespace

Outcome check_output_place(const std::string& file, std::uintmax_t room) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code fault;
  if (!folder.empty() && !std::filesystem::is_directory(folder, fault))
    return Error{ErrorKind::write, fmt::format("{}: cannot be written: there is no folder {}; make it first",
                                               file, folder.string())};
  AtomicFile probe;  // goes again when it is not committed
  if (Outcome opened = probe.open(file.c_str()); !opened) return opened;
  if (!std::filesystem::is_regular_file(file, fault) && std::filesystem::exists(file, fault))
    return success();
  const std::filesystem::space_info space =
      std::filesystem::space(folder.empty() ? std::filesystem::path(".") : folder, fault);
  if (fault || space.available >= room) return success();
  return Error{ErrorKind::write, fmt::format("{}: {:.1f} MB are free there and up to {:.0f} MB needed; free "
                                             "some space, or write elsewhere",
                                             file, megabytes(space.available), megabytes(room))};
}

}  // namespace pliant
