#include "firmware-app/commands/scene.hpp"

#include <fmt/format.h>

#include <utility>

#include "drivers/view_files/view_files.hpp"

namespace pliant {

Result<Scene> read_scene(const std::string& path, const std::string& camera) {
  Scene scene;
  scene.is_picture = is_png(path);
  if (!scene.is_picture) {
    if (!camera.empty())
      return Error{ErrorKind::bad_input, fmt::format("--camera is for depth pictures; {} is none", path)};
    Result<Geometry> cloud = read_geometry(path);
    if (!cloud) return cloud.error();
    scene.cloud = std::move(*cloud);
    return scene;
  }
  if (camera.empty())
    return Error{ErrorKind::bad_input,
                 fmt::format("{} is a depth picture: give its camera with --camera camera.toml", path)};
  Result<CameraFile> read = read_camera(camera);
  if (!read) return read.error();
  scene.camera = *read;
  Result<GreyImage16> picture = read_depth_picture(path, scene.camera.intrinsics, camera);
  if (!picture) return picture.error();
  scene.picture = std::move(*picture);
  return scene;
}

}  // namespace pliant
