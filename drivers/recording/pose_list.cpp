#include "drivers/recording/pose_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <sstream>

#include "drivers/recording/text_file.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMostBytes = 256U << 20;
constexpr double kSameTime = 0.002;  // seconds

}  // namespace

Result<std::vector<StampedPose>> read_pose_list(const std::string& path) {
  const Result<std::string> text = read_text_file(path, kMostBytes);
  if (!text) return Error{ErrorKind::bad_input, "cannot read the poses " + text.error().message};
  std::vector<StampedPose> poses;
  std::istringstream lines(*text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.empty() || line[0] == '#' || line == "\r") continue;
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::array<double, 8> v{};
    bool well = true;
    for (double& value : v) well = well && (words >> value) && std::isfinite(value);
    const double norm = std::sqrt(v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7]);
    if (!well || !(std::fabs(norm - 1) < 1e-3))
      return Error{ErrorKind::bad_input,
                   fmt::format("{}:{}: expected '<seconds> tx ty tz qx qy qz qw' with a unit quaternion",
                               path, number)};
    poses.push_back({v[0], Vector3(v[1], v[2], v[3]), {v[7] / norm, v[4] / norm, v[5] / norm, v[6] / norm}});
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.seconds < b.seconds; });
  return poses;
}

const StampedPose* pose_at(const std::vector<StampedPose>& poses, double seconds) {
  const auto next = std::lower_bound(poses.begin(), poses.end(), seconds - kSameTime,
                                     [](const StampedPose& pose, double at) { return pose.seconds < at; });
  return next != poses.end() && next->seconds <= seconds + kSameTime ? &*next : nullptr;
}

}  // namespace pliant
