// Writes a recording frame by frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "drivers/common/result.hpp"
#include "drivers/recording/camera_file.hpp"

namespace pliant {

/// Writes the layout that open_recording() reads. A frame is listed only after its picture is whole, and the
/// lists are flushed with every frame: stopped at any time, what stands in the folder is a valid recording.
class RecordingWriter {
 public:
  /// Makes the folder where it is missing. A folder that already holds a recording is refused
  /// (ErrorKind::bad_input); a folder or file that cannot be written is an ErrorKind::write.
  [[nodiscard]] static Result<std::unique_ptr<RecordingWriter>> create(const std::filesystem::path& folder,
                                                                       const CameraFile& camera);

  /// Appends a frame; its file is named by its position in this recording. The frame must have the camera's
  /// size and a stamp that is_listable().
  [[nodiscard]] Outcome write(const DepthFrame& frame);
  /// Appends "<seconds> tx ty tz qx qy qz qw" to groundtruth.txt, which comes into being with its first line.
  [[nodiscard]] Outcome write_truth(std::int64_t utime, const RigidTransform& camera_from_model);
  /// Closes the files; what the system could not store shows here at the latest. Further calls do nothing.
  [[nodiscard]] Outcome finish();

  [[nodiscard]] std::int64_t frames() const { return frames_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  RecordingWriter(std::filesystem::path folder, const CameraFile& camera)
      : folder_(std::move(folder)), camera_(camera) {}
  [[nodiscard]] Outcome open_list(const char* name, const std::string& heading, File& list) const;
  void remove_picture(const std::string& name) const;
  [[nodiscard]] Outcome append(File& list, const char* name, const std::string& line) const;

  std::filesystem::path folder_;
  CameraFile camera_;
  File depth_list_, truth_list_;
  std::int64_t frames_ = 0;
  std::vector<std::byte> png_;
};

}  // namespace pliant
