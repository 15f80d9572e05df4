// A recording as a source of frames.
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/common/result.hpp"
#include "drivers/depth_source/depth_source.hpp"

namespace pliant {

/// Opens a folder in the TUM RGB-D layout: camera.toml, depth.txt, 16-bit PNG pictures.
///
/// Frames carry their position in depth.txt as number and its stamp as utime. A picture that is missing, cut
/// short or of another size than camera.toml says is a SourceEvent::bad_frame. Pictures are decoded ahead on
/// a thread of the source's own; order and content do not depend on it. ErrorKind::bad_input when the folder,
/// one of the two text files or their content is unusable.
[[nodiscard]] Result<std::unique_ptr<DepthSource>> open_recording(const std::filesystem::path& folder);

}  // namespace pliant
