#include "drivers/simulated/structure_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "drivers/simulated/hash_random.hpp"

namespace pliant::simulated {

namespace {

constexpr std::int32_t kPixel = 1 << kDisparityBits;
constexpr double kFullWidth = 640;  ///< pixels; disparity is measured at this size
constexpr std::uint32_t kFlickerSize = 256, kFixedSize = 128, kFixedLayers = 8;
constexpr std::size_t kFixedRow = std::size_t{kFixedLayers} * kFixedSize;

/// Flicker before rounding to eighths, in eighths: with the rounding it shows as the 0.5 to 0.7 of a still
/// scene at 0.45 to 0.65 m.
constexpr double kFlicker = 0.45;
/// Mean square of an interpolated pair of independent values against that of one: 2/3.
constexpr double kInterpolation = 1.22474487139;
/// Share of readings lost anywhere: 0.3 %, the flicker field above 2.75 deviations.
constexpr int kLostAbove = 88;
/// Change of disparity per pixel of the full image: from here on matching windows suffer (68° at 0.65 m).
constexpr double kSteep = 0.28;
/// Pixels to either side that a matching window mixes at an edge.
constexpr int kReach = 2;

std::int32_t difference(std::int32_t a, std::int32_t b) {
  return std::abs(a - b);
}

}  // namespace

StructureSensor::StructureSensor(const Intrinsics& camera, const SensorDescription& sensor,
                                 std::uint64_t seed)
    : width_(camera.width),
      height_(camera.height),
      seed_(seed),
      flicker_field_(kFlickerSize, mixed(seed, 1)) {
  const double scale = kFullWidth / width_;
  pixel_step_ = static_cast<std::int32_t>(scale * kPixel);
  steep_ = static_cast<std::int32_t>(2 * kReach * scale * kSteep * kPixel);
  shadow_extra_ = static_cast<std::uint32_t>(4 / scale * 256);
  last_column_ = width_ - std::max(1, static_cast<int>(8 / scale));
  field_step_ = static_cast<std::uint32_t>(scale * 256);
  shadow_.resize(static_cast<std::size_t>(width_));
  fixed_fields_.resize(kFixedRow * kFixedSize);
  for (std::uint32_t layer = 0; layer < kFixedLayers; ++layer) {
    const NoiseField field(kFixedSize, mixed(seed, 100 + layer));
    for (std::uint32_t v = 0; v < kFixedSize; ++v)
      std::copy_n(field.row(v), kFixedSize,
                  fixed_fields_.data() + v * kFixedRow + std::size_t{layer} * kFixedSize);
  }

  const auto most = static_cast<std::size_t>(8 * kFocalBaseline / sensor.near_limit);
  for (std::size_t eighths = 0; eighths <= most; ++eighths) {
    const double z = 8 * kFocalBaseline / static_cast<double>(std::max<std::size_t>(eighths, 1));
    const double step = z * z / (8 * kFocalBaseline);
    const double all = sensor.sigma(std::min(z, 8.0)) / step;
    const double flicker = std::min(kFlicker, 0.8 * all);
    const double fixed = std::sqrt(std::max(all * all - flicker * flicker - 1.0 / 12, 0.0));
    deviation_.push_back(
        {static_cast<std::int32_t>(256 * kInterpolation * fixed), static_cast<std::int32_t>(256 * flicker)});
    millimetres_.push_back(z > 8 ? std::uint16_t{0} : static_cast<std::uint16_t>(std::floor(1000 * z + 0.5)));
  }
}

void StructureSensor::find_shadow(const std::int32_t* row, std::uint32_t key) {
  // Seen from the projector, pixel u lies at u - d. Whatever a pixel further right covers there is dark.
  std::int64_t reached = std::numeric_limits<std::int64_t>::max() / 2;
  std::uint32_t extra = 0;
  for (int u = width_ - 1; u >= 0; --u) {
    std::uint8_t dark = 0;
    if (row[u] > 0) {
      const std::int64_t at = static_cast<std::int64_t>(u) * pixel_step_ - row[u];
      if (at > reached + kPixel / 2) {
        dark = 1;
        extra = (shadow_extra_ * (64 + (mixed32(key + static_cast<std::uint32_t>(u)) & 255))) >> 16;
      } else {
        reached = std::min(reached, at);
      }
    }
    if (dark == 0 && extra > 0) {
      dark = 1;
      --extra;
    }
    shadow_[static_cast<std::size_t>(u)] = dark;
  }
}

int StructureSensor::fixed_error(const std::int8_t* fixed_row, std::uint32_t u, std::int32_t disparity) {
  const auto layer = static_cast<std::uint32_t>(disparity >> kDisparityBits);
  const int part = (disparity >> (kDisparityBits - 8)) & 255;
  const std::size_t at = u % kFixedSize;
  return (256 - part) * fixed_row[std::size_t{layer % kFixedLayers} * kFixedSize + at] +
         part * fixed_row[std::size_t{(layer + 1) % kFixedLayers} * kFixedSize + at];
}

std::int32_t StructureSensor::matched_at_edge(const Rows& rows, int u, int flicker, int fixed) const {
  const std::int32_t centre = rows.here[u];
  const int before = std::max(u - 1, 0);
  const int after = std::min(u + 1, width_ - 1);
  const std::int32_t left = rows.here[std::max(u - kReach, 0)];
  const std::int32_t right = rows.here[std::min(u + kReach, width_ - 1)];
  const std::int32_t above = rows.above[u];
  const std::int32_t below = rows.below[u];
  const std::int32_t change = std::max(difference(left, right), difference(above, below));
  const std::int32_t bend =
      std::max(difference(left + right, 2 * centre), difference(above + below, 2 * centre));
  // Partly the same in every frame, partly not; standard deviation about 32.
  const int luck = (12 * fixed + 30 * flicker) / 32;

  if (bend < change / 2) {  // a steep surface, no edge: lost the more often the steeper
    const int lost_above = 66 - static_cast<int>(32 * static_cast<std::int64_t>(change - steep_) / steep_);
    return luck > lost_above ? 0 : centre;
  }
  const std::int32_t at_once = std::max(difference(rows.here[before], rows.here[after]),
                                        difference(rows.just_above[u], rows.just_below[u]));
  const bool at_jump = at_once > change / 2;
  if (luck > (at_jump ? -8 : 44)) return 0;  // 60 % and 8 % of them
  const std::uint32_t dice = mixed32(rows.key ^ static_cast<std::uint32_t>(u) * 0x9e3779b9U);
  const std::int32_t other[4] = {left, right, above, below};
  const std::int32_t neighbour = other[dice >> 30];
  const std::uint32_t chance = dice & 255;
  if (chance < (at_jump ? 128U : 24U)) return neighbour;          // the edge is matched a pixel off
  if (at_jump && chance < 148U && neighbour > 0 && centre > 0) {  // flies between near and far
    const std::int64_t share = dice >> 8 & 255;
    return static_cast<std::int32_t>((share * neighbour + (256 - share) * centre) >> 8);
  }
  return centre;
}

void StructureSensor::measure(const DisparityImage& scene, std::int64_t number,
                              std::span<std::uint16_t> depth) {
  const std::int32_t* pixels = scene.pixels().data();
  const auto frame = static_cast<std::uint64_t>(number);
  // Each frame lays the flicker field elsewhere, and the one of the frame before shines through.
  const auto now = mixed(seed_ ^ 0x5eedU, frame + 1);
  const auto before = mixed(seed_ ^ 0x5eedU, frame);
  const auto most = static_cast<std::int32_t>(millimetres_.size()) - 1;
  for (int v = 0; v < height_; ++v) {
    const auto row_of = [&](int y) {
      return pixels + static_cast<std::ptrdiff_t>(std::clamp(y, 0, height_ - 1)) * width_;
    };
    const auto row_key = static_cast<std::uint32_t>(mixed(now, static_cast<std::uint64_t>(v)));
    const Rows rows{row_of(v - kReach),
                    row_of(v - 1),
                    row_of(v),
                    row_of(v + 1),
                    row_of(v + kReach),
                    static_cast<std::uint32_t>(v),
                    row_key};
    find_shadow(rows.here, row_key);
    const std::uint32_t field_v = rows.v * field_step_ >> 8;
    const std::int8_t* flicker_now = flicker_field_.row(field_v + static_cast<std::uint32_t>(now >> 32));
    const std::int8_t* flicker_before =
        flicker_field_.row(field_v + static_cast<std::uint32_t>(before >> 32));
    const std::int8_t* fixed_row = fixed_fields_.data() + field_v % kFixedSize * kFixedRow;
    const std::uint32_t mask = flicker_field_.mask();
    std::uint16_t* out = depth.data() + static_cast<std::ptrdiff_t>(v) * width_;
    for (int u = 0; u < width_; ++u) {
      out[u] = 0;
      if (shadow_[static_cast<std::size_t>(u)] != 0 || u >= last_column_) continue;
      const std::uint32_t field_u = static_cast<std::uint32_t>(u) * field_step_ >> 8;
      const int flicker = (15 * flicker_now[(field_u + static_cast<std::uint32_t>(now)) & mask] +
                           6 * flicker_before[(field_u + static_cast<std::uint32_t>(before)) & mask]) /
                          16;
      if (flicker > kLostAbove) continue;
      std::int32_t d = rows.here[u];
      const std::int32_t change = std::max(
          difference(rows.here[std::max(u - kReach, 0)], rows.here[std::min(u + kReach, width_ - 1)]),
          difference(rows.above[u], rows.below[u]));
      if (change > steep_) d = matched_at_edge(rows, u, flicker, fixed_row[(field_u + 64) % kFixedSize]);
      if (d <= 0) continue;
      const auto eighths = static_cast<std::size_t>(std::min(d >> (kDisparityBits - 3), most));
      const Deviation deviation = deviation_[eighths];
      const std::int32_t error =
          deviation.fixed * fixed_error(fixed_row, field_u, d) / (256 * NoiseField::kDeviation) +
          deviation.flicker * flicker / NoiseField::kDeviation;
      const std::int32_t measured = ((d >> (kDisparityBits - 11)) + error + 128) >> 8;
      if (measured > 0 && measured <= most) out[u] = millimetres_[static_cast<std::size_t>(measured)];
    }
  }
}

}  // namespace pliant::simulated
