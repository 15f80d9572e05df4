#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "drivers/geometry_files/points_ply.hpp"
#include "firmware-app/export/exporters.hpp"
#include "firmware-app/outputs/trajectory_writer.hpp"

namespace pliant {

namespace {

class TumExporter final : public LogExporter {
 public:
  TumExporter(TrajectoryWriter writer, std::string path)
      : writer_(std::move(writer)), path_(std::move(path)) {}

  Outcome pose(std::int64_t /*received_us*/, const PoseMessage& pose) override {
    ++lines_;
    return writer_.write(pose.utime, Vector3(pose.trans[0], pose.trans[1], pose.trans[2]),
                         {pose.quat[0], pose.quat[1], pose.quat[2], pose.quat[3]});
  }
  Outcome finish() override { return writer_.finish(); }
  [[nodiscard]] std::string summary() const override { return fmt::format("{} poses in {}", lines_, path_); }

 private:
  TrajectoryWriter writer_;
  std::string path_;
  std::int64_t lines_ = 0;
};

class PlyExporter final : public LogExporter {
 public:
  explicit PlyExporter(std::string folder) : folder_(std::move(folder)) {}

  Outcome frame(std::int64_t /*received_us*/, const ReceivedFrame& frame, const ReceivedModel* model,
                std::span<const Point3f> positions) override {
    if (frame.frame <= last_frame_) ++run_;
    last_frame_ = frame.frame;
    if (model == nullptr) {
      without_model_ += frame.state == TrackState::tracking ? 1 : 0;
      return success();
    }
    if (writer_ == nullptr || model_id_ != model->model_id) {
      writer_ = std::make_unique<PointsPlyWriter>(model->points);
      model_id_ = model->model_id;
      matches_.assign(model->points.size(), -1);
      residuals_.assign(model->points.size(), std::numeric_limits<float>::quiet_NaN());
    }
    const std::string prefix = run_ == 1 ? std::string() : fmt::format("run{}_", run_);
    const std::string path = fmt::format("{}/{}{:06}.ply", folder_, prefix, frame.frame);
    ++files_;
    return writer_->write(path.c_str(), positions, frame.labels, matches_, residuals_);
  }
  Outcome finish() override {
    if (files_ == 0 && without_model_ > 0)
      return Error{ErrorKind::bad_input,
                   "the log does not hold the model that was tracked; give it with --model FILE"};
    return success();
  }
  [[nodiscard]] std::string summary() const override {
    return fmt::format("{} files in {}", files_, folder_);
  }

 private:
  std::string folder_;
  std::unique_ptr<PointsPlyWriter> writer_;
  std::int64_t model_id_ = 0, last_frame_ = -1, files_ = 0, without_model_ = 0;
  int run_ = 1;
  std::vector<std::int32_t> matches_;
  std::vector<float> residuals_;
};

bool is_frame_file(const std::string& name) {
  return name.size() >= 10 && name.ends_with(".ply") &&
         name.find_first_not_of("0123456789", name.size() - 10) == name.size() - 4;
}

}  // namespace

Result<std::unique_ptr<LogExporter>> export_tum(const std::string& path) {
  Result<TrajectoryWriter> writer = TrajectoryWriter::create(path, TrajectoryWriter::Appears::when_whole);
  if (!writer) return writer.error();
  return std::unique_ptr<LogExporter>(std::make_unique<TumExporter>(std::move(*writer), path));
}

Result<std::unique_ptr<LogExporter>> export_ply(const std::string& folder) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  std::filesystem::directory_iterator entries;
  if (!fault) entries = std::filesystem::directory_iterator(folder, fault);
  if (fault)
    return Error{ErrorKind::write, fmt::format("cannot make the folder {}: {}", folder, fault.message())};
  for (const auto& entry : entries)
    if (is_frame_file(entry.path().filename().string()))
      return Error{ErrorKind::bad_input,
                   fmt::format("{} already holds points files; name a fresh folder", folder)};
  return std::unique_ptr<LogExporter>(std::make_unique<PlyExporter>(folder));
}

}  // namespace pliant
