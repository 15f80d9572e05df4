// Depth devices and .oni files through libOpenNI2.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "drivers/depth_source/depth_source.hpp"
#include "drivers/depth_source/source_wish.hpp"
#include "drivers/openni2/openni2_library.hpp"

namespace pliant {

/// Opens the device `uri` names, or the first one where it is empty. A URI whose device is not there, but one
/// that differs in its last part only (the number that USB gives anew at every plugging), opens that one.
/// ErrorKind::absent where there is none, ErrorKind::device where it cannot be used. Frames' utime is on the
/// wall clock, by a measured offset.
[[nodiscard]] Result<std::unique_ptr<DepthSource>> open_openni2(std::shared_ptr<OpenNi2Library> library,
                                                                std::string_view uri, const SourceWish& wish);

/// Plays an .oni file, every frame once, as fast as they are asked for; utime is the recording's stamp. A
/// recording that was made mirrored is turned back. ErrorKind::bad_input where the file is missing or no
/// recording.
[[nodiscard]] Result<std::unique_ptr<DepthSource>> open_oni(std::shared_ptr<OpenNi2Library> library,
                                                            const std::filesystem::path& file,
                                                            const SourceWish& wish);

}  // namespace pliant
