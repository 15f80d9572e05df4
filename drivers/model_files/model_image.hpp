// Lays out a model image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/model/model_view.hpp"
#include "drivers/model_files/spring_network.hpp"

namespace pliant {

/// The contents of an image; of `header` the counts, offsets, size and checksum are filled in.
struct ModelParts {
  ModelHeader header;
  std::span<const Point3f> positions;
  std::span<const Normal16> normals;
  std::span<const std::uint16_t> neighbours;
  std::span<const Descriptor> descriptors;
  std::span<const LocalFrame> frames;
  const SpringNetwork& network;
};

[[nodiscard]] std::vector<std::byte> make_model_image(const ModelParts& parts);

/// Puts the right checksum into an image's header.
void seal_model_image(std::span<std::byte> image);

}  // namespace pliant
