// Whether a file is laid out as an .oni recording, before libOpenNI2 reads it.
#pragma once

#include <filesystem>

#include "drivers/common/result.hpp"

namespace pliant {

/// The file's header and the chain of its records' headers: each whole, inside the file and leading to the
/// next. ErrorKind::bad_input says what is wrong and where. What the records hold is the library's to read.
[[nodiscard]] Outcome check_oni_layout(const std::filesystem::path& file);

}  // namespace pliant
