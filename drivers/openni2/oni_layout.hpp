// Whether a file is laid out as an .oni recording, before libOpenNI2 reads it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "drivers/common/result.hpp"

namespace pliant {

/// The file's header and the chain of its records: each whole, inside the file, leading to the next, and such
/// that the library takes it (oni_records.hpp). ErrorKind::bad_input says what is wrong and where. What the
/// pictures hold is the library's to read.
[[nodiscard]] Outcome check_oni_layout(const std::filesystem::path& file);
/// The same of an open file of `size` bytes; `name` stands in errors.
[[nodiscard]] Outcome check_oni_layout(std::FILE* file, std::uint64_t size, std::string_view name);

}  // namespace pliant
