// Trajectory and points files, written on a thread of their own so that a slow disk does not hold up a frame.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/track_result.hpp"
#include "drivers/common/result.hpp"
#include "drivers/geometry_files/points_ply.hpp"
#include "firmware-app/outputs/trajectory_writer.hpp"
#include "firmware-app/pipeline/worker.hpp"

namespace pliant {

struct FrameFilesSettings {
  std::string trajectory;     ///< file, empty for none
  std::string points;         ///< folder, empty for none
  bool wait_for_disk = true;  ///< false: a frame that the disk has no time for is left out and counted
};

class FrameFiles {
 public:
  /// Opens the files and starts the thread. ErrorKind::bad_input when the points folder already holds
  /// NNNNNN.ply files; ErrorKind::write when something cannot be written. `rest`: the model's points.
  [[nodiscard]] static Result<std::unique_ptr<FrameFiles>> create(const FrameFilesSettings& settings,
                                                                  std::span<const Point3f> rest);
  FrameFiles(const FrameFiles&) = delete;
  FrameFiles& operator=(const FrameFiles&) = delete;
  ~FrameFiles();

  /// Copies what the files need. No heap call. Nothing is written for a frame that is not tracked.
  void submit(const TrackResult& result);
  /// Writes what is left, closes the files; the first error of the whole run.
  [[nodiscard]] Outcome finish();
  /// The first error so far, empty when there was none. After it nothing more is written.
  [[nodiscard]] std::string failure() const;
  /// Frames left out because the disk had no time for them.
  [[nodiscard]] std::uint64_t left_out() const;

 private:
  static constexpr std::size_t kSlots = 8;
  struct Slot {
    std::int64_t utime = 0, frame = 0;
    bool has_pose = false;
    RigidTransform pose;
    std::vector<Point3f> positions;
    std::vector<std::int8_t> labels;
    std::vector<std::int32_t> matches;
    std::vector<float> residuals;
  };

  FrameFiles(const FrameFilesSettings& settings, std::span<const Point3f> rest);
  void run();
  [[nodiscard]] Outcome write(const Slot& slot);

  const FrameFilesSettings settings_;
  std::optional<TrajectoryWriter> trajectory_;
  std::optional<PointsPlyWriter> points_;
  std::string path_;
  std::array<Slot, kSlots> slots_;
  Worker worker_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t first_ = 0, queued_ = 0;  // slots [first_, first_ + queued_) are full
  bool closed_ = false;
  std::uint64_t left_out_ = 0;
  std::optional<Error> error_;
};

}  // namespace pliant
