// The LZF compression of PCD files (format of Marc Lehmann's liblzf).
#pragma once

#include <cstddef>
#include <span>

namespace pliant {

/// Unpacks `packed` into `unpacked`, which it must fill exactly. False when it is malformed or of another
/// size.
[[nodiscard]] bool lzf_unpack(std::span<const std::byte> packed, std::span<std::byte> unpacked);

/// The most that one packed byte can unpack to: a back reference of 3 bytes gives 264.
inline constexpr std::size_t kLzfMostPerByte = 88;

}  // namespace pliant
