// Letters for pictures: five pixels wide, seven high.
#pragma once

#include <array>
#include <cstdint>

namespace pliant {

/// Rows from the top; the lowest five bits are the pixels, the left one highest.
using Glyph = std::array<std::uint8_t, 7>;
inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 7;

/// Printable ASCII; a space for anything else, a frame for what is not drawn.
[[nodiscard]] const Glyph& glyph(char character);

}  // namespace pliant
