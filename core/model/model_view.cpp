#include "core/model/model_view.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>

#include "core/model/network_checks.hpp"

namespace pliant {

namespace {

bool finite(double x) {
  return x - x == 0;
}

/// A section of `count` items of T at `offset`, or empty when it does not lie wholly behind the header.
template <typename T>
bool section(std::span<const std::byte> image, std::uint64_t offset, std::size_t count,
             std::span<const T>& out) {
  if (offset % 64 != 0 || offset < sizeof(ModelHeader) || offset > image.size()) return false;
  if ((image.size() - offset) / sizeof(T) < count) return false;
  out = {static_cast<const T*>(static_cast<const void*>(image.data() + offset)), count};
  return true;
}

/// The centre lies in the bounding box, the sphere is no larger than one around it, and points lie no farther
/// apart than the sphere is wide: what is converted to integers is bounded by the box alone.
bool sizes_fit(const ModelHeader& h) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    if (!(h.centre[i] >= h.lowest[i] && h.centre[i] <= h.highest[i])) return false;
    square += (h.highest[i] - h.lowest[i]) * (h.highest[i] - h.lowest[i]);
  }
  return finite(square) && h.radius * h.radius <= square && h.spacing <= 2 * h.radius;
}

bool header_is_sane(const ModelHeader& h) {
  bool good = finite(h.spacing) && h.spacing > 0 && finite(h.radius) && h.radius > 0 &&
              finite(h.support_radius) && h.support_radius > 0 && h.characterisability >= 0 &&
              h.characterisability <= 1 && h.material >= 0 && h.material <= 1 && finite(h.patch_radius) &&
              h.patch_radius > 0;
  for (int i = 0; i < 3; ++i)
    good = good && finite(h.centre[i]) && finite(h.lowest[i]) && finite(h.highest[i]) &&
           h.lowest[i] <= h.highest[i];
  return good && sizes_fit(h) &&
         h.ambiguity <= static_cast<std::uint32_t>(ModelHeader::Ambiguity::featureless);
}

bool contents_are_sane(const ModelView& view, std::span<const std::uint16_t> neighbours) {
  const ModelHeader& h = view.header();
  for (const Point3f& p : view.positions()) {
    const float xyz[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i)
      if (!(static_cast<double>(xyz[i]) >= h.lowest[i] && static_cast<double>(xyz[i]) <= h.highest[i]))
        return false;
  }
  for (const Normal16& n : view.normals()) {
    const std::int64_t square = std::int64_t{n.x} * n.x + std::int64_t{n.y} * n.y + std::int64_t{n.z} * n.z;
    if (square < std::int64_t{16000} * 16000 || square > std::int64_t{16768} * 16768) return false;
  }
  for (const std::uint16_t n : neighbours)
    if (n != kNoNeighbour && n >= h.point_count) return false;
  for (const Descriptor& d : view.descriptors()) {
    std::int32_t square = 0;  // below 352 · 2^14
    for (const std::int8_t bin : d.bins) {
      if (bin < 0) return false;
      square += bin * bin;
    }
    if (square > Descriptor::kMostSquare) return false;
  }
  for (const LocalFrame& f : view.frames())
    for (const std::int16_t component : f.axes)
      if (component < -16400 || component > 16400) return false;
  return true;
}

}  // namespace

const char* describe(ModelFault fault) noexcept {
  switch (fault) {
    case ModelFault::none:
      return "is well";
    case ModelFault::too_short:
      return "is too short to be a model file; build it with 'pliant model build'";
    case ModelFault::not_a_model:
      return "is not a model file; build one from it with 'pliant model build'";
    case ModelFault::foreign_byte_order:
      return "was built for a machine of the other byte order; build it again";
    case ModelFault::newer_version:
      return "was written by a newer version; update pliant or build it again";
    case ModelFault::older_version:
      return "was written by an older version; build it again with 'pliant model build'";
    case ModelFault::truncated:
      return "is not as long as it says (cut short?); copy or build it again";
    case ModelFault::corrupt:
      return "is corrupt (its checksum or contents are wrong); copy or build it again";
    case ModelFault::over_limit:
      return "holds more than this version can track; build it again";
  }
  return "is not usable";
}

std::uint64_t model_checksum(std::span<const std::byte> image) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (std::size_t i = 0; i + 8 <= image.size(); i += 8) {
    if (i == offsetof(ModelHeader, checksum)) continue;
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < 8; ++k) word |= static_cast<std::uint64_t>(image[i + k]) << (8 * k);
    hash = (hash ^ word) * 0x100000001b3U;
    hash ^= hash >> 29;  // carries high bits down, so that every bit of a word counts
  }
  return hash;
}

ModelFault ModelView::open(std::span<const std::byte> image, ModelView& view) noexcept {
  view = ModelView();
  if (image.size() < sizeof(ModelHeader::kMagic)) return ModelFault::too_short;
  if (std::memcmp(image.data(), ModelHeader::kMagic.data(), ModelHeader::kMagic.size()) != 0)
    return ModelFault::not_a_model;
  if (image.size() < sizeof(ModelHeader)) return ModelFault::truncated;
  const auto* header = static_cast<const ModelHeader*>(static_cast<const void*>(image.data()));
  if (header->byte_order == __builtin_bswap32(ModelHeader::kByteOrder)) return ModelFault::foreign_byte_order;
  if (header->byte_order != ModelHeader::kByteOrder) return ModelFault::corrupt;
  if (header->version > ModelHeader::kVersion) return ModelFault::newer_version;
  if (header->version < ModelHeader::kVersion) return ModelFault::older_version;
  if (header->bytes > image.size()) return ModelFault::truncated;
  if (header->bytes != image.size() || header->bytes % 8 != 0) return ModelFault::corrupt;
  if (model_checksum(image) != header->checksum) return ModelFault::corrupt;
  if (header->point_count > limits::kMaxModelPoints || header->keypoint_count > limits::kMaxModelKeypoints ||
      header->patch_count > limits::kMaxPatches || header->surface_link_count > limits::kMaxBorders ||
      header->body_link_count > limits::kMaxBodyLinks)
    return ModelFault::over_limit;
  if (header->point_count == 0 || header->keypoint_count == 0 ||
      header->keypoint_count > header->point_count || header->patch_count == 0 ||
      header->patch_count > header->point_count || !header_is_sane(*header))
    return ModelFault::corrupt;

  const std::size_t points = header->point_count, keypoints = header->keypoint_count;
  ModelView candidate;
  candidate.header_ = header;
  if (!section(image, header->positions_offset, points, candidate.positions_) ||
      !section(image, header->normals_offset, points, candidate.normals_) ||
      !section(image, header->neighbours_offset, points * limits::kNeighbours, candidate.neighbours_) ||
      !section(image, header->descriptors_offset, keypoints, candidate.descriptors_) ||
      !section(image, header->frames_offset, keypoints, candidate.frames_) ||
      !section(image, header->patch_of_offset, points, candidate.patch_of_) ||
      !section(image, header->blends_offset, points, candidate.blends_) ||
      !section(image, header->patches_offset, header->patch_count, candidate.patches_) ||
      !section(image, header->surface_links_offset, header->surface_link_count, candidate.surface_links_) ||
      !section(image, header->body_links_offset, header->body_link_count, candidate.body_links_))
    return ModelFault::corrupt;
  if (!contents_are_sane(candidate, candidate.neighbours_) || !network_is_sane(candidate))
    return ModelFault::corrupt;
  view = candidate;
  return ModelFault::none;
}

}  // namespace pliant
