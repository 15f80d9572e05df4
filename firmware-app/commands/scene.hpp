// The scene of a registration: a cloud or a depth picture.
#pragma once

#include <cstdint>
#include <string>

#include "core/camera/depth_frame.hpp"
#include "drivers/common/result.hpp"
#include "drivers/geometry_files/geometry.hpp"
#include "drivers/images/png.hpp"
#include "drivers/recording/camera_file.hpp"

namespace pliant {

struct Scene {
  bool is_picture = false;
  Geometry cloud;       ///< of a cloud
  GreyImage16 picture;  ///< of a depth picture
  CameraFile camera;

  [[nodiscard]] std::size_t point_count() const {
    return is_picture ? picture.pixels.size() : cloud.vertices.size();
  }
  [[nodiscard]] DepthFrame frame() const {
    return {picture.pixels.data(), picture.width, picture.height, picture.width, 0, 0};
  }
  /// The file's number of a matched point: points that are not finite are not read, but counted.
  [[nodiscard]] std::int32_t index_in_file(std::int32_t match) const {
    if (match < 0 || is_picture || cloud.original_index.empty()) return match;
    return static_cast<std::int32_t>(cloud.original_index[static_cast<std::size_t>(match)]);
  }
};

/// A PNG file needs its camera.toml and must have its size; anything else is read as a cloud.
[[nodiscard]] Result<Scene> read_scene(const std::string& path, const std::string& camera);

}  // namespace pliant
