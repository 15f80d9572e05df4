#include "firmware-app/pictures/trajectory_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <numbers>
#include <sstream>

#include "core/geometry/rigid_transform.hpp"
#include "drivers/recording/text_file.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMostBytes = 256U << 20;

struct StampedPose {
  double seconds = 0;
  Vector3 place = Vector3::Zero();
  Quaternion turn;
};

Result<std::vector<StampedPose>> read_path(const std::string& path) {
  const Result<std::string> text = read_text_file(path, kMostBytes);
  if (!text) return Error{ErrorKind::bad_input, "cannot read the path " + text.error().message};
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

}  // namespace

Result<std::vector<PoseError>> trajectory_errors(const std::string& path, const std::string& truth) {
  const Result<std::vector<StampedPose>> found = read_path(path);
  if (!found) return found.error();
  const Result<std::vector<StampedPose>> real = read_path(truth);
  if (!real) return real.error();
  constexpr double kSameTime = 0.002;
  std::vector<PoseError> errors;
  auto companion = real->begin();
  for (const StampedPose& pose : *found) {
    while (companion != real->end() && companion->seconds < pose.seconds - kSameTime) ++companion;
    if (companion == real->end()) break;
    if (companion->seconds > pose.seconds + kSameTime) continue;
    const Matrix3 turn =
        rotation_from_quaternion(companion->turn).transpose() * rotation_from_quaternion(pose.turn);
    errors.push_back({pose.seconds - found->front().seconds, (pose.place - companion->place).norm(),
                      std::acos(std::clamp(cos_angle(turn), -1.0, 1.0)) * 180 / std::numbers::pi});
  }
  if (errors.empty())
    return Error{ErrorKind::bad_input,
                 fmt::format("no pose of {} has one of the same time in {}", path, truth)};
  return errors;
}

}  // namespace pliant
