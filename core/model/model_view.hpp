// The one cached model: a flat, position-independent image that the device holds, and a checked view
// of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/geometry/rigid_transform.hpp"
#include "core/limits.hpp"
#include "core/model/spring_network.hpp"

namespace pliant {

/// SHOT: 32 volumes (8 azimuth, 2 elevation, 2 radial) of 11 bins of the normals' cosine.
inline constexpr int kDescriptorSize = 352;

/// A unit normal in Q14 (16384 = 1), padded to eight bytes.
struct Normal16 {
  std::int16_t x = 0, y = 0, z = 0, pad = 0;
};

/// Eight-bit SHOT descriptor, each component >= 0, of Euclidean norm <= 136.4: 127 and the rounding of 352
/// components.
struct Descriptor {
  static constexpr std::int32_t kMostSquare = 18605;  ///< of its norm

  std::array<std::int8_t, kDescriptorSize> bins;
};

/// Axes of a keypoint's local reference frame in the model frame, rows x, y, z, Q14; all 0 where the shape
/// fixes none.
struct LocalFrame {
  std::array<std::int16_t, 9> axes;
};
/// Its rows as a rotation: local <- model.
[[nodiscard]] inline Matrix3 axes_of(const LocalFrame& frame) noexcept {
  Matrix3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = frame.axes[static_cast<std::size_t>(i)] / 16384.0;
  return m;
}

/// First bytes of a model image. Little-endian; offsets from the image's first byte, multiples of 64.
/// The checksum is FNV-1a (64 bits, over 64-bit little-endian words) of the whole image but itself.
struct ModelHeader {
  static constexpr std::array<char, 8> kMagic = {'P', 'L', 'I', 'A', 'N', 'T', 'M', '\n'};
  static constexpr std::uint32_t kByteOrder = 0x01020304;
  static constexpr std::uint32_t kVersion = 3;  ///< 3: holds the spring network
  enum Flags : std::uint32_t {
    kCharacterisable = 1,  ///< its shape tells where it is; not so for a sphere or a plane
    kClosedSurface = 2,    ///< built from a mesh without a border
    kFrontOnly = 4         ///< the back is unknown
  };
  /// Why a shape cannot be localised.
  enum class Ambiguity : std::uint32_t {
    none = 0,
    sphere = 1,
    plane = 2,
    rotation = 3,
    translation = 4,
    featureless = 5
  };

  std::array<char, 8> magic = kMagic;
  std::uint32_t byte_order = kByteOrder;
  std::uint32_t version = kVersion;
  std::uint64_t bytes = 0;  ///< of the whole image
  std::uint64_t checksum = 0;
  std::uint32_t flags = 0;
  std::uint32_t ambiguity = 0;  ///< Ambiguity
  std::uint32_t point_count = 0;
  std::uint32_t keypoint_count = 0;  ///< the first points are the keypoints
  double spacing = 0;                ///< mean distance of a point to its nearest other, metres
  double support_radius = 0;         ///< radius of the descriptors, metres
  double radius = 0;                 ///< of the sphere around `centre` that holds all points, metres
  double centre[3] = {0, 0, 0};      ///< of the bounding box, metres, model frame
  double lowest[3] = {0, 0, 0};      ///< bounding box, metres, model frame
  double highest[3] = {0, 0, 0};
  double characterisability = 0;         ///< [0, 1]; 0: a motion exists that the shape does not notice
  std::uint64_t positions_offset = 0;    ///< Point3f[point_count], model frame as in the input, metres
  std::uint64_t normals_offset = 0;      ///< Normal16[point_count], outward
  std::uint64_t neighbours_offset = 0;   ///< uint16[point_count][kNeighbours], nearest first, 0xFFFF none
  std::uint64_t descriptors_offset = 0;  ///< Descriptor[keypoint_count]
  std::uint64_t frames_offset = 0;       ///< LocalFrame[keypoint_count]
  std::uint32_t patch_count = 0;
  std::uint32_t surface_link_count = 0;
  std::uint32_t body_link_count = 0;
  std::uint32_t pad = 0;
  double material = 0.5;                   ///< how easily the object stretches: 0 stiff … 1 soft [0, 1]
  double patch_radius = 0;                 ///< of the disc as wide as a patch, metres
  std::uint64_t patch_of_offset = 0;       ///< uint8[point_count], the patch that the point belongs to
  std::uint64_t blends_offset = 0;         ///< PointBlend[point_count]
  std::uint64_t patches_offset = 0;        ///< ModelPatch[patch_count]
  std::uint64_t surface_links_offset = 0;  ///< SurfaceLink[surface_link_count], ascending by (a, b)
  std::uint64_t body_links_offset = 0;     ///< BodyLink[body_link_count], ascending by (a, b)
  std::uint64_t reserved[7] = {0, 0, 0, 0, 0, 0, 0};
};
static_assert(sizeof(ModelHeader) == 320 && sizeof(ModelHeader) % 64 == 0);
static_assert(sizeof(Descriptor) == kDescriptorSize && sizeof(LocalFrame) == 18);

inline constexpr std::uint16_t kNoNeighbour = 0xFFFF;

/// Why an image was refused.
enum class ModelFault : std::uint8_t {
  none,
  too_short,
  not_a_model,
  foreign_byte_order,
  newer_version,
  older_version,
  truncated,
  corrupt,
  over_limit
};
/// One line for people: what is wrong and the mend.
[[nodiscard]] const char* describe(ModelFault fault) noexcept;

/// A checked view of a model image. Points stand in farthest-point order: any prefix is a uniform sampling.
class ModelView {
 public:
  ModelView() noexcept = default;
  /// Checks `image` (8-byte aligned) in full: header, checksum, every offset and index, finite numbers,
  /// lengths that fit the bounding box, unit normals, the range of descriptors and frames, the spring
  /// network. On success `view` looks into `image`, which must outlive it.
  [[nodiscard]] static ModelFault open(std::span<const std::byte> image, ModelView& view) noexcept;

  [[nodiscard]] bool empty() const noexcept { return header_ == nullptr; }
  [[nodiscard]] const ModelHeader& header() const noexcept { return *header_; }
  [[nodiscard]] std::size_t size() const noexcept { return header_->point_count; }
  [[nodiscard]] std::size_t keypoint_count() const noexcept { return header_->keypoint_count; }
  [[nodiscard]] std::span<const Point3f> positions() const noexcept { return positions_; }
  [[nodiscard]] std::span<const Normal16> normals() const noexcept { return normals_; }
  /// kNeighbours entries for point i.
  [[nodiscard]] std::span<const std::uint16_t> neighbours(std::size_t i) const noexcept {
    return neighbours_.subspan(i * limits::kNeighbours, limits::kNeighbours);
  }
  [[nodiscard]] std::span<const Descriptor> descriptors() const noexcept { return descriptors_; }
  [[nodiscard]] std::span<const LocalFrame> frames() const noexcept { return frames_; }
  /// The spring network; see spring_network.hpp.
  [[nodiscard]] std::span<const std::uint8_t> patch_of() const noexcept { return patch_of_; }
  [[nodiscard]] std::span<const PointBlend> blends() const noexcept { return blends_; }
  [[nodiscard]] std::span<const ModelPatch> patches() const noexcept { return patches_; }
  [[nodiscard]] std::span<const SurfaceLink> surface_links() const noexcept { return surface_links_; }
  [[nodiscard]] std::span<const BodyLink> body_links() const noexcept { return body_links_; }
  [[nodiscard]] double patch_radius() const noexcept { return header_->patch_radius; }
  [[nodiscard]] double material() const noexcept { return header_->material; }
  [[nodiscard]] double spacing() const noexcept { return header_->spacing; }
  [[nodiscard]] Vector3 centre() const noexcept {
    return {header_->centre[0], header_->centre[1], header_->centre[2]};
  }
  [[nodiscard]] double radius() const noexcept { return header_->radius; }
  [[nodiscard]] bool characterisable() const noexcept {
    return (header_->flags & ModelHeader::kCharacterisable) != 0;
  }

 private:
  const ModelHeader* header_ = nullptr;
  std::span<const Point3f> positions_;
  std::span<const Normal16> normals_;
  std::span<const std::uint16_t> neighbours_;
  std::span<const Descriptor> descriptors_;
  std::span<const LocalFrame> frames_;
  std::span<const std::uint8_t> patch_of_;
  std::span<const PointBlend> blends_;
  std::span<const ModelPatch> patches_;
  std::span<const SurfaceLink> surface_links_;
  std::span<const BodyLink> body_links_;
};

/// ModelHeader::checksum of an image, whose size must be a multiple of eight.
[[nodiscard]] std::uint64_t model_checksum(std::span<const std::byte> image) noexcept;

}  // namespace pliant
