// The header of a PLY file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"
#include "drivers/geometry_files/numbers.hpp"

namespace pliant {

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::float32;  ///< of the value, or of each item of a list
  bool is_list = false;
  NumberType count_type = NumberType::uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  ///< as declared
  std::vector<PlyProperty> properties;

  /// Index of the property, -1 when there is none.
  [[nodiscard]] int find(std::string_view property) const;
  /// The fewest bytes that one item can take.
  [[nodiscard]] std::uint64_t least_bytes(bool ascii) const;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  ///< of the header; the data follow
  std::size_t lines = 0;
};

[[nodiscard]] Result<PlyHeader> parse_ply_header(std::span<const std::byte> data, std::string_view name);

}  // namespace pliant
