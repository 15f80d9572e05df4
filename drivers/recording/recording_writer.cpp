#include "drivers/recording/recording_writer.hpp"

#include <fmt/core.h>
#include <stdio_ext.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "drivers/images/png.hpp"
#include "drivers/recording/depth_list.hpp"

namespace pliant {

namespace {

Error failed(const std::filesystem::path& file, std::string_view reason) {
  return {ErrorKind::write, fmt::format("{}: {}", file.string(), reason)};
}

/// Microseconds as seconds with six decimals, exactly.
std::string seconds(std::int64_t utime) {
  return fmt::format("{}.{:06}", utime / 1000000, utime % 1000000);
}

}  // namespace

Result<std::unique_ptr<RecordingWriter>> RecordingWriter::create(const std::filesystem::path& folder,
                                                                 const CameraFile& camera) {
  if (folder.empty()) return Error{ErrorKind::bad_input, "the recording to be written names no folder"};
  if (const char* fault = intrinsics_fault(camera.intrinsics))
    return Error{ErrorKind::bad_input, fmt::format("{}: cannot record: {}", folder.string(), fault)};
  std::error_code fault;
  for (const char* name : {"camera.toml", "depth.txt", "depth", "groundtruth.txt"})
    if (std::filesystem::exists(folder / name, fault))
      return Error{ErrorKind::bad_input,
                   fmt::format("{}: already holds {}; name an empty or new folder", folder.string(), name)};
  std::filesystem::create_directories(folder / "depth", fault);
  if (fault) return failed(folder / "depth", fault.message());

  std::unique_ptr<RecordingWriter> writer(new RecordingWriter(folder, camera));
  File camera_file;
  if (Outcome made = writer->open_list("camera.toml", camera_text(camera), camera_file); !made)
    return made.error();
  if (Outcome made = writer->open_list("depth.txt", "# seconds file\n", writer->depth_list_); !made)
    return made.error();
  return writer;
}

Outcome RecordingWriter::write(const DepthFrame& frame) {
  const Intrinsics& camera = camera_.intrinsics;
  if (frame.width != camera.width || frame.height != camera.height)
    return failed(folder_, fmt::format("a frame of {}x{} pixels does not fit this recording's camera",
                                       frame.width, frame.height));
  if (!is_listable(frame.utime))
    return failed(folder_, fmt::format("no recording can hold a stamp of {} microseconds", frame.utime));
  const std::string name = fmt::format("depth/{:06}.png", frames_);
  if (Outcome stored =
          write_png_grey16(folder_ / name, {frame.depth, frame.width, frame.height, frame.stride}, png_);
      !stored) {
    remove_picture(name);
    return stored;
  }
  if (Outcome listed = append(depth_list_, "depth.txt", fmt::format("{} {}\n", seconds(frame.utime), name));
      !listed) {
    remove_picture(name);
    return listed;
  }
  ++frames_;
  return success();
}

Outcome RecordingWriter::write_truth(std::int64_t utime, const RigidTransform& camera_from_model) {
  if (!truth_list_)
    if (Outcome made = open_list("groundtruth.txt", "# seconds tx ty tz qx qy qz qw\n", truth_list_); !made)
      return made;
  const Quaternion q = quaternion_from_rotation(camera_from_model.rotation);
  const Vector3& t = camera_from_model.translation;
  return append(truth_list_, "groundtruth.txt",
                fmt::format("{} {:.6f} {:.6f} {:.6f} {:.7f} {:.7f} {:.7f} {:.7f}\n", seconds(utime), t.x(),
                            t.y(), t.z(), q.x, q.y, q.z, q.w));
}

Outcome RecordingWriter::finish() {
  Outcome all = success();
  const auto close = [&](File& list, const char* name) {
    if (!list) return;
    if (std::fclose(list.release()) != 0 && all) all = failed(folder_ / name, std::strerror(errno));
  };
  close(depth_list_, "depth.txt");
  close(truth_list_, "groundtruth.txt");
  return all;
}

Outcome RecordingWriter::open_list(const char* name, const std::string& heading, File& list) const {
  list.reset(std::fopen((folder_ / name).c_str(), "wb"));
  if (!list) return failed(folder_ / name, std::strerror(errno));
  return append(list, name, heading);
}

Outcome RecordingWriter::append(File& list, const char* name, const std::string& line) const {
  if (!list) return failed(folder_ / name, "the recording is finished");
  const off_t before = ftello(list.get());
  if (std::fputs(line.c_str(), list.get()) >= 0 && std::fflush(list.get()) == 0) return success();
  const int error = errno;
  // Half a line would spoil the list: what stands there stays, what could not be written goes.
  __fpurge(list.get());
  if (before < 0 || ftruncate(fileno(list.get()), before) != 0 || fseeko(list.get(), before, SEEK_SET) != 0)
    return failed(folder_ / name, fmt::format("{}; its last line may be cut", std::strerror(error)));
  return failed(folder_ / name, std::strerror(error));
}

void RecordingWriter::remove_picture(const std::string& name) const {
  std::error_code ignored;
  std::filesystem::remove(folder_ / name, ignored);
}

}  // namespace pliant
