#include "firmware-app/commands/scene.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>

namespace pliant {

namespace {

bool is_png(const std::string& path) {
  std::array<char, 4> start{};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  return file && start == std::array<char, 4>{'\x89', 'P', 'N', 'G'};
}

}  // namespace

Result<Scene> read_scene(const std::string& path, const std::string& camera) {
  Scene scene;
  scene.is_picture = is_png(path) || path.ends_with(".png");
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
  PngReader reader;
  if (const Outcome decoded = reader.read(path, scene.picture); !decoded) return decoded.error();
  const Intrinsics& intrinsics = scene.camera.intrinsics;
  if (scene.picture.width != intrinsics.width || scene.picture.height != intrinsics.height)
    return Error{ErrorKind::bad_input,
                 fmt::format("{} is {}x{}, its camera {} is {}x{}", path, scene.picture.width,
                             scene.picture.height, camera, intrinsics.width, intrinsics.height)};
  return scene;
}

}  // namespace pliant
