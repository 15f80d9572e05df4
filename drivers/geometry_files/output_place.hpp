#pragma once

#include <cstdint>
#include <string>

#include "drivers/common/result.hpp"

namespace pliant {

/// Whether `file` can be written, tried by a file beside it that goes again, and whether `room` bytes are
/// free there; a device or a pipe needs none. Errors name the file, what stands against it, and the mend.
[[nodiscard]] Outcome check_output_place(const std::string& file, std::uintmax_t room);

}  // namespace pliant
