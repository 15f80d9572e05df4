#include "tests/vm/guest.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "drivers/recording/recording.hpp"
#include "drivers/v4l2/v4l2.hpp"
#include "firmware-app/measure/clock.hpp"
#include "tests/vm/forth_and_back.hpp"

namespace pliant::test {

namespace {

constexpr const char* kNetwork = "udpm://239.255.76.67:7667?ttl=0";

std::string sensor_text(const Intrinsics& camera, double rate) {
  std::ostringstream text;
  text << "name = \"camera of the tests\"\n[mode]\nwidth = " << camera.width << "\nheight = " << camera.height
       << "\nrate = " << rate << "\n[camera]\nfx = " << camera.fx << "\nfy = " << camera.fy
       << "\ncx = " << camera.cx << "\ncy = " << camera.cy << "\ndepth_scale = " << camera.depth_scale
       << "\n";
  return text.str();
}

std::vector<RigidTransform> read_poses(const std::string& file) {
  std::vector<RigidTransform> poses;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream numbers(line);
    double seconds = 0;
    RigidTransform pose;
    Quaternion q{};
    numbers >> seconds >> pose.translation[0] >> pose.translation[1] >> pose.translation[2] >> q.x >> q.y >>
        q.z >> q.w;
    pose.rotation = rotation_from_quaternion(q);
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace

bool wait_until(double seconds, const std::function<bool()>& met) {
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  while (!met()) {
    if (monotonic_ns() > end) return false;
    usleep(20'000);
  }
  return true;
}

const Recorded& recorded() {
  static const Recorded all = [] {
    Recorded read;
    const auto source = open_recording(kRecording);
    if (!source) {
      ADD_FAILURE() << source.error().message;
      return read;
    }
    read.camera = (*source)->intrinsics();
    SourceItem item;
    for (;;) {
      (*source)->next(10'000, item);
      if (item.event != SourceEvent::frame) break;
      read.pictures.emplace_back(item.frame.depth,
                                 item.frame.depth + std::ptrdiff_t{item.frame.width} * item.frame.height);
    }
    read.poses = read_poses(std::string(kRecording) + "/groundtruth.txt");
    EXPECT_EQ(read.poses.size(), read.pictures.size());
    return read;
  }();
  return all;
}

V4l2Node depth_node(const std::string& bus) {
  for (const V4l2Node& node : list_v4l2().nodes)
    if (node.offers_depth() && node.bus == bus) return node;
  return {};
}

Tracking::Tracking(const std::filesystem::path& folder, const std::string& source, double rate)
    : folder_(folder) {
  LcmSubscriber::Handlers handlers;
  handlers.status = [this](const StatusMessage& status) {
    latest_ = status;
    ++heard_;
    if (!states_.ends_with(name_of(status.device))) states_ += std::string(" ") + name_of(status.device);
    if (!status.last_error.empty() && errors_.find(status.last_error) == std::string::npos)
      errors_ += "\n  " + status.last_error;
  };
  handlers.regions = [this](const RegionsMessage& told) {
    if (told.regions.empty() || told.regions.front().id != 0) return;
    const std::size_t picture =
        forth_and_back(static_cast<std::size_t>(told.frame), recorded().pictures.size());
    const auto& place = told.regions.front().trans;
    const Vector3 error = recorded().poses.at(picture).translation - Vector3(place[0], place[1], place[2]);
    errors_of_place_.push_back(error.norm());
  };
  auto subscriber = LcmSubscriber::create(kNetwork, "PLIANT", handlers);
  if (!subscriber) {
    ADD_FAILURE() << subscriber.error().message;
    return;
  }
  subscriber_ = std::move(*subscriber);
  const std::filesystem::path sensor = folder_ / "sensor.toml";
  write_file(sensor, sensor_text(recorded().camera, rate));
  process_ = start_pliant({"run", "--source", source, "--sensor", sensor.string(), "--model", kModel,
                           "--lcm-url", kNetwork, "--stats", (folder_ / "stats.json").string()},
                          folder_);
}

Tracking::~Tracking() {
  if (process_ > 0) static_cast<void>(stop());
}

bool Tracking::ended() {
  siginfo_t about{};
  return process_ <= 0 ||
         (waitid(P_PID, static_cast<id_t>(process_), &about, WEXITED | WNOHANG | WNOWAIT) == 0 &&
          about.si_pid == process_);
}

bool Tracking::until(double seconds, const std::function<bool(const StatusMessage&)>& met) {
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  while (subscriber_ != nullptr && monotonic_ns() < end && !ended()) {
    const std::int64_t before = heard_;
    subscriber_->handle(100);
    if (heard_ != before && met(latest_)) return true;
  }
  return false;
}

double Tracking::median_error() const {
  if (errors_of_place_.empty()) return 1e9;
  std::vector<double> sorted = errors_of_place_;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  return sorted[sorted.size() / 2];
}

double Tracking::rate_over(double seconds) {
  const StatusMessage begin = latest_;
  const auto enough = static_cast<std::int64_t>(seconds * 1e6);
  static_cast<void>(
      until(2 * seconds + 5, [&](const StatusMessage& now) { return now.utime - begin.utime >= enough; }));
  const std::int64_t span = std::max<std::int64_t>(latest_.utime - begin.utime, 1);
  return 1e6 * static_cast<double>(latest_.tracked - begin.tracked) / static_cast<double>(span);
}

double Tracking::rate_within(double seconds) {
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  double most = 0;
  while (most < kLeastRate && monotonic_ns() < end && !ended()) most = std::max(most, rate_over(5));
  return most;
}

Ended Tracking::stop() {
  kill(process_, SIGTERM);
  Ended ended = wait_for(process_, folder_);
  process_ = -1;
  return ended;
}

std::string Tracking::told() const {
  std::ostringstream text;
  text << "states:" << states_ << "; frames tracked " << latest_.tracked << ", searching "
       << latest_.searching << ", lost " << latest_.lost << ", dropped " << latest_.dropped << ", bad "
       << latest_.bad_frames << ", slow " << latest_.slow_frames << "; a frame takes "
       << latest_.latency_median << " us; errors:" << errors_
       << "\nits own words: " << read_file(folder_ / "err.txt");
  return text.str();
}

}  // namespace pliant::test
