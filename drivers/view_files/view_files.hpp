// Single views from files as a source of frames.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/common/result.hpp"
#include "drivers/depth_source/depth_source.hpp"
#include "drivers/images/png.hpp"

namespace pliant {

/// Reads a 16-bit PNG that must have the size of `camera`, whose file `camera_file` stands in the errors.
[[nodiscard]] Result<GreyImage16> read_depth_picture(const std::string& path, const Intrinsics& camera,
                                                     const std::string& camera_file);

struct ViewFilesSettings {
  std::string camera;          ///< camera.toml of depth pictures; not for clouds alone
  double metres_per_unit = 1;  ///< of the clouds' coordinates
};

/// Depth pictures (16-bit PNG, all of the camera's size) and clouds (PLY, PCD; each in the frame of the
/// camera that took it: x right, y down, z forward, the camera at the origin), which are drawn as pictures of
/// that camera or, where there is none, of one that fits them. Frames have the position in `files` as number
/// and as stamp, in seconds. All is read at once. ErrorKind::bad_input names the file and what is wrong.
[[nodiscard]] Result<std::unique_ptr<DepthSource>> open_view_files(const std::vector<std::string>& files,
                                                                   const ViewFilesSettings& settings);

}  // namespace pliant
