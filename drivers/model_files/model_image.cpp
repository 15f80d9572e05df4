#include "drivers/model_files/model_image.hpp"

#include <bit>
#include <cstring>

namespace pliant {

static_assert(std::endian::native == std::endian::little, "model images are written little-endian");

namespace {

constexpr std::size_t kSectionAlignment = 64;

/// Appends `items` at the next multiple of kSectionAlignment. Returns its offset.
template <typename T>
std::uint64_t append(std::vector<std::byte>& image, std::span<T> items) {
  const std::size_t offset = (image.size() + kSectionAlignment - 1) / kSectionAlignment * kSectionAlignment;
  image.resize(offset + items.size_bytes());
  if (!items.empty()) std::memcpy(image.data() + offset, items.data(), items.size_bytes());
  return offset;
}

}  // namespace

std::vector<std::byte> make_model_image(const ModelParts& parts) {
  ModelHeader header = parts.header;
  header.point_count = static_cast<std::uint32_t>(parts.positions.size());
  header.keypoint_count = static_cast<std::uint32_t>(parts.descriptors.size());
  header.patch_count = static_cast<std::uint32_t>(parts.network.patches.size());
  header.surface_link_count = static_cast<std::uint32_t>(parts.network.surface_links.size());
  header.body_link_count = static_cast<std::uint32_t>(parts.network.body_links.size());
  header.patch_radius = parts.network.patch_radius;
  std::vector<std::byte> image(sizeof(ModelHeader));
  header.positions_offset = append(image, parts.positions);
  header.normals_offset = append(image, parts.normals);
  header.neighbours_offset = append(image, parts.neighbours);
  header.descriptors_offset = append(image, parts.descriptors);
  header.frames_offset = append(image, parts.frames);
  header.patch_of_offset = append(image, std::span(parts.network.patch_of));
  header.blends_offset = append(image, std::span(parts.network.blends));
  header.patches_offset = append(image, std::span(parts.network.patches));
  header.surface_links_offset = append(image, std::span(parts.network.surface_links));
  header.body_links_offset = append(image, std::span(parts.network.body_links));
  image.resize((image.size() + kSectionAlignment - 1) / kSectionAlignment * kSectionAlignment);
  header.bytes = image.size();
  std::memcpy(image.data(), &header, sizeof header);
  seal_model_image(image);
  return image;
}

void seal_model_image(std::span<std::byte> image) {
  ModelHeader header;
  std::memcpy(&header, image.data(), sizeof header);
  header.checksum = model_checksum(image);
  std::memcpy(image.data(), &header, sizeof header);
}

}  // namespace pliant
