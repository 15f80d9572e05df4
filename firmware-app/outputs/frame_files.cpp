#include "firmware-app/outputs/frame_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "drivers/geometry_files/output_place.hpp"

namespace pliant {

namespace {

/// Whether `name` is one of the files that a run writes: six digits or more and ".ply".
bool is_points_file(const std::string& name) {
  constexpr std::string_view kEnd = ".ply";
  if (name.size() < 6 + kEnd.size() || !name.ends_with(kEnd)) return false;
  return std::all_of(name.begin(), name.end() - static_cast<std::ptrdiff_t>(kEnd.size()),
                     [](char c) { return c >= '0' && c <= '9'; });
}

Outcome prepare_folder(const std::string& folder) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (!std::filesystem::is_directory(folder))
    return Error{ErrorKind::write, fmt::format("cannot make the points folder {}: {}", folder,
                                               fault ? fault.message() : "a file of that name is there")};
  std::filesystem::directory_iterator entry(folder, fault);
  for (; !fault && entry != std::filesystem::directory_iterator(); entry.increment(fault))
    if (is_points_file(entry->path().filename().string()))
      return Error{ErrorKind::bad_input,
                   fmt::format("the points folder {} already holds {}; name another folder or empty this one",
                               folder, entry->path().filename().string())};
  if (fault)
    return Error{ErrorKind::write,
                 fmt::format("cannot read the points folder {}: {}", folder, fault.message())};
  // The first frame may be tracked long after the start.
  return check_output_place(folder + "/000000.ply", 0);
}

}  // namespace

FrameFiles::FrameFiles(const FrameFilesSettings& settings, std::span<const Point3f> rest)
    : settings_(settings) {
  path_.reserve(settings.points.size() + 32);
  if (settings_.points.empty()) return;
  points_.emplace(rest);
  for (Slot& slot : slots_) {
    slot.positions.resize(rest.size());
    slot.labels.resize(rest.size());
    slot.matches.resize(rest.size());
    slot.residuals.resize(rest.size());
  }
}

Result<std::unique_ptr<FrameFiles>> FrameFiles::create(const FrameFilesSettings& settings,
                                                       std::span<const Point3f> rest) {
  if (!settings.points.empty())
    if (Outcome ready = prepare_folder(settings.points); !ready) return ready.error();
  std::unique_ptr<FrameFiles> files(new FrameFiles(settings, rest));
  if (!settings.trajectory.empty()) {
    Result<TrajectoryWriter> trajectory =
        TrajectoryWriter::create(settings.trajectory, TrajectoryWriter::Appears::by_lines);
    if (!trajectory) return trajectory.error();
    files->trajectory_.emplace(std::move(*trajectory));
  }
  std::string warning;
  FrameFiles* self = files.get();
  if (Outcome started = files->worker_.start(
          {.name = "pliant-files", .priority = 0, .affinity = {}}, [self] { self->run(); }, warning);
      !started)
    return started.error();
  return files;
}

FrameFiles::~FrameFiles() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  worker_.join();
}

void FrameFiles::submit(const TrackResult& result) {
  if (!result.frame_used || result.state != TrackState::tracking) return;
  std::unique_lock lock(mutex_);
  if (queued_ == kSlots && !settings_.wait_for_disk) {
    ++left_out_;
    return;
  }
  changed_.wait(lock, [this] { return queued_ < kSlots || error_ || closed_; });
  if (error_ || closed_) return;
  Slot& slot = slots_[(first_ + queued_) % kSlots];
  lock.unlock();  // only this thread fills slots

  slot.utime = result.utime;
  slot.frame = result.frame;
  slot.has_pose = !result.regions.empty() && result.regions.front().id == 0;
  slot.pose = result.pose;
  if (points_) {
    std::copy(result.positions.begin(), result.positions.end(), slot.positions.begin());
    std::copy(result.labels.begin(), result.labels.end(), slot.labels.begin());
    std::copy(result.matches.begin(), result.matches.end(), slot.matches.begin());
    std::copy(result.residuals.begin(), result.residuals.end(), slot.residuals.begin());
  }

  lock.lock();
  ++queued_;
  changed_.notify_all();
}

void FrameFiles::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return queued_ > 0 || closed_; });
    if (queued_ == 0) return;
    const Slot& slot = slots_[first_];
    if (!error_) {
      lock.unlock();
      const Outcome written = write(slot);
      lock.lock();
      if (!written) error_ = written.error();
    }
    first_ = (first_ + 1) % kSlots;
    --queued_;
    changed_.notify_all();
  }
}

Outcome FrameFiles::write(const Slot& slot) {
  if (trajectory_ && slot.has_pose)
    if (Outcome written = trajectory_->write(slot.utime, slot.pose); !written) return written;
  if (!points_) return success();
  path_.clear();
  fmt::format_to(std::back_inserter(path_), "{}/{:06}.ply", settings_.points, slot.frame);
  return points_->write(path_.c_str(), slot.positions, slot.labels, slot.matches, slot.residuals);
}

Outcome FrameFiles::finish() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  worker_.join();
  if (trajectory_ && !error_)
    if (Outcome closed = trajectory_->finish(); !closed) error_ = closed.error();
  if (error_) return *error_;
  return success();
}

std::string FrameFiles::failure() const {
  const std::lock_guard lock(mutex_);
  return error_ ? error_->message : std::string();
}

std::uint64_t FrameFiles::left_out() const {
  const std::lock_guard lock(mutex_);
  return left_out_;
}

}  // namespace pliant
