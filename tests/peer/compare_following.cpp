// Pliant's tracker beside PCL's projective ICP on the same recording, frame by frame in turn, one thread
// each:
//   compare_following RECORDING
// Both begin at the pose of RECORDING/groundtruth.txt's first line. Prints a row: processor time of a
// frame, median, and how far the base is off that truth, median; Pliant's without its warp, too, since PCL's
// is of one rigid body.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "core/tracker.hpp"
#include "drivers/recording/pose_list.hpp"
#include "drivers/recording/recording.hpp"
#include "tests/accuracy/registration_runs.hpp"
#include "tests/peer/pcl_tracking.hpp"

namespace pliant {
namespace {

struct Column {
  std::vector<double> ms, degrees, millimetres;

  void add(double took, const RigidTransform& pose, const RigidTransform& truth, const Vector3& centre) {
    ms.push_back(took);
    degrees.push_back(degrees_between(pose.rotation, truth.rotation));
    millimetres.push_back(1e3 * (pose * centre - truth * centre).norm());
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("{:.2f} | {:.2f}° {:.2f} mm", median_of(ms), median_of(degrees),
                       median_of(millimetres));
  }
};

/// How long a frame's warp took: what the tracker does before label and regrouping beside the rigid regions.
struct WarpClock {
  double last = 0, warp = 0;

  void begin() {
    last = thread_ms();
    warp = 0;
  }
  static void stage_done(void* context, Stage stage) noexcept {
    auto& clock = *static_cast<WarpClock*>(context);
    const double now = thread_ms();
    if (stage == Stage::deform && clock.warp == 0) clock.warp = now - clock.last;
    clock.last = now;
  }
};

peer::Points plain(std::span<const Point3f> points) {
  peer::Points out;
  for (const Point3f& p : points) out.push_back({p.x, p.y, p.z});
  return out;
}

std::array<double, 16> rows_of(const RigidTransform& pose) {
  std::array<double, 16> out{};
  out[15] = 1;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      out[static_cast<std::size_t>(4 * row + column)] = pose.rotation(row, column);
    out[static_cast<std::size_t>(4 * row + 3)] = pose.translation[row];
  }
  return out;
}

RigidTransform transform_of(const std::array<double, 16>& rows) {
  RigidTransform pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      pose.rotation(row, column) = rows[static_cast<std::size_t>(4 * row + column)];
    pose.translation[row] = rows[static_cast<std::size_t>(4 * row + 3)];
  }
  return pose;
}

int fail(const std::string& why) {
  std::fprintf(stderr, "compare_following: %s\n", why.c_str());
  return 2;
}

int compare(const std::filesystem::path& recording) {
  auto source = open_recording(recording);
  if (!source) return fail(source.error().message);
  const auto truth = read_pose_list((recording / "groundtruth.txt").string());
  if (!truth) return fail(truth.error().message);
  if (truth->empty()) return fail("no pose in " + (recording / "groundtruth.txt").string());
  const BuiltFromFile model(recording / "model.ply");
  if (!model.good) return fail("no model.ply in " + recording.string());
  const Intrinsics& camera = (*source)->intrinsics();
  const TrackSettings settings;
  const AlignedBlock block(Tracker::workspace_bytes(model.view, camera, settings));
  Tracker tracker;
  if (const char* fault = tracker.start(model.view, camera, (*source)->sensor(), settings, block.bytes))
    return fail(fault);
  tracker.start_from((*truth)[0].transform());

  peer::Points normals;
  for (std::size_t i = 0; i < model.view.size(); ++i) {
    const auto n = model.view.normals()[i];
    constexpr float kUnit = 1 / 16384.0F;
    normals.push_back(
        {static_cast<float>(n.x) * kUnit, static_cast<float>(n.y) * kUnit, static_cast<float>(n.z) * kUnit});
  }
  peer::PclTracker half(plain(model.view.positions()), normals, 2),
      full(plain(model.view.positions()), normals, 1);
  half.start_from(rows_of((*truth)[0].transform()));
  full.start_from(rows_of((*truth)[0].transform()));

  WarpClock clock;
  tracker.observe({&WarpClock::stage_done, &clock});
  Column ours, of_half, of_full;
  std::vector<double> without_warp;
  SourceItem item;
  for ((*source)->next(1000, item); item.event != SourceEvent::end; (*source)->next(1000, item)) {
    if (item.event != SourceEvent::frame) continue;
    const StampedPose* const now = pose_at(*truth, static_cast<double>(item.frame.utime) * 1e-6);
    if (now == nullptr) continue;
    const RigidTransform true_pose = now->transform();
    const peer::Picture picture{
        item.frame.depth,  camera.width, camera.height, static_cast<int>(item.frame.stride),
        camera.fx,         camera.fy,    camera.cx,     camera.cy,
        camera.depth_scale};
    clock.begin();
    double start = thread_ms();
    const TrackResult& result = tracker.process(item.frame);
    double took = thread_ms() - start;
    if (result.state == TrackState::tracking) {
      ours.add(took, result.pose, true_pose, model.view.centre());
      without_warp.push_back(took - clock.warp);
    }
    for (auto& [peer_tracker, column] : {std::pair{&half, &of_half}, std::pair{&full, &of_full}}) {
      start = thread_ms();
      const RigidTransform pose = transform_of(peer_tracker->process(picture));
      took = thread_ms() - start;
      column->add(took, pose, true_pose, model.view.centre());
    }
  }
  const double rigid = median_of(without_warp), half_ms = median_of(of_half.ms);
  fmt::print("| {} ({} points) | {} | {:.2f} | {} | {:.1f}× | {:.1f}× | {} | {:.1f}× |\n",
             recording.filename().string(), model.view.size(), ours.text(), rigid, of_half.text(),
             half_ms / median_of(ours.ms), half_ms / rigid, of_full.text(),
             median_of(of_full.ms) / median_of(ours.ms));
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: compare_following RECORDING\n", stderr);
    return 2;
  }
  return pliant::compare(argv[1]);
}
