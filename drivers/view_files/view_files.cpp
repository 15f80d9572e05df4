#include "drivers/view_files/view_files.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/recording/camera_file.hpp"
#include "drivers/view_files/cloud_picture.hpp"

namespace pliant {

namespace {

class ViewFiles final : public DepthSource {
 public:
  ViewFiles(const CameraFile& camera, std::vector<std::vector<std::uint16_t>> pictures)
      : camera_(camera), pictures_(std::move(pictures)) {}

  [[nodiscard]] const Intrinsics& intrinsics() const override { return camera_.intrinsics; }
  [[nodiscard]] const SensorDescription& sensor() const override { return camera_.sensor; }
  [[nodiscard]] bool live() const override { return false; }
  [[nodiscard]] std::int64_t frame_count() const override {
    return static_cast<std::int64_t>(pictures_.size());
  }
  [[nodiscard]] double rate() const override { return 1; }
  void close() override { next_ = pictures_.size(); }
  void next(int /*timeout_ms*/, SourceItem& item) override {
    item.fault.clear();
    item.frame = {};
    item.event = SourceEvent::end;
    if (next_ >= pictures_.size()) return;
    const Intrinsics& camera = camera_.intrinsics;
    const auto number = static_cast<std::int64_t>(next_);
    item.event = SourceEvent::frame;
    item.frame = {pictures_[next_++].data(), camera.width, camera.height, camera.width,
                  number * 1'000'000,        number};
  }

 private:
  CameraFile camera_;
  std::vector<std::vector<std::uint16_t>> pictures_;
  std::size_t next_ = 0;
};

Error refuse(std::string message) {
  return {ErrorKind::bad_input, std::move(message)};
}

Result<ViewCloud> read_cloud(const std::string& path, double metres_per_unit) {
  const Result<Geometry> geometry = read_geometry(path);
  if (!geometry) return geometry.error();
  ViewCloud cloud;
  std::size_t before = 0;
  for (const Point3f& p : geometry->vertices) {
    cloud.push_back(metres_per_unit * to_vector(p));
    before += cloud.back().z() > 0 ? 1U : 0U;
  }
  if (2 * before < cloud.size() || cloud.empty())
    return refuse(fmt::format(
        "{}: {} of its {} points lie before the camera; a view's cloud is in the frame of its camera, x "
        "right, y down, z forward (a whole cloud, seen from all sides, is for 'pliant model build')",
        path, before, cloud.size()));
  return cloud;
}

}  // namespace

Result<GreyImage16> read_depth_picture(const std::string& path, const Intrinsics& camera,
                                       const std::string& camera_file) {
  PngReader reader;
  GreyImage16 image;
  if (const Outcome decoded = reader.read(path, image); !decoded) return decoded.error();
  if (image.width != camera.width || image.height != camera.height)
    return refuse(fmt::format("{} is {}x{}, its camera {} is {}x{}", path, image.width, image.height,
                              camera_file, camera.width, camera.height));
  return image;
}

Result<std::unique_ptr<DepthSource>> open_view_files(const std::vector<std::string>& files,
                                                     const ViewFilesSettings& settings) {
  std::optional<CameraFile> camera;
  if (!settings.camera.empty()) {
    Result<CameraFile> read = read_camera(settings.camera);
    if (!read) return read.error();
    camera = *read;
  }
  std::vector<std::vector<std::uint16_t>> pictures(files.size());
  std::vector<ViewCloud> clouds;
  std::vector<std::size_t> cloud_of;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (is_png(files[i])) {
      if (!camera)
        return refuse(
            fmt::format("{} is a depth picture: give its camera with --camera camera.toml", files[i]));
      Result<GreyImage16> picture = read_depth_picture(files[i], camera->intrinsics, settings.camera);
      if (!picture) return picture.error();
      pictures[i] = std::move(picture->pixels);
      continue;
    }
    Result<ViewCloud> cloud = read_cloud(files[i], settings.metres_per_unit);
    if (!cloud) return cloud.error();
    clouds.push_back(std::move(*cloud));
    cloud_of.push_back(i);
  }
  if (!camera) {
    camera.emplace();
    camera->intrinsics = camera_for(clouds);
    if (camera->intrinsics.width == 0)
      return refuse(fmt::format("{}: its points lie too far aside for a camera", files.front()));
    if (const char* fault = intrinsics_fault(camera->intrinsics))
      return refuse(fmt::format("{}: no camera fits it: {}; check its unit (--units)", files.front(), fault));
  }
  for (std::size_t k = 0; k < clouds.size(); ++k)
    pictures[cloud_of[k]] = draw_cloud(clouds[k], camera->intrinsics);
  return std::unique_ptr<DepthSource>(std::make_unique<ViewFiles>(*camera, std::move(pictures)));
}

}  // namespace pliant
