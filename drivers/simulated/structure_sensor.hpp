// What a structured-light sensor of the PrimeSense family makes of a scene.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera/sensor.hpp"
#include "drivers/simulated/disparity_image.hpp"
#include "drivers/simulated/noise_field.hpp"

namespace pliant::simulated {

/// Turns true disparity into raw depth in millimetres, with the faults of the real thing:
/// - disparity is known in eighths of a pixel, so that depth comes in steps of z² / (8 · 42.75 m): 1.4 mm at
///   0.7 m;
/// - an error that stands still with the pixel and the distance, and one that flickers; together as large as
///   SensorDescription::sigma() says, both alike over neighbouring pixels;
/// - no reading where the projector, 75 mm to the right of the camera, does not shine: a shadow to the left
/// of
///   near objects, two to three pixels wider than geometry has it; none in the last columns, which the
///   matching window does not reach; none of most surfaces seen at a grazing angle; a few lost at random;
/// - edges that are lost, that flicker between near and far, and that fly between the two.
/// The figures are those of Nguyen, Izadi, Lovell (3DIMPVT 2012) for the axial error and of still scenes of
/// a PrimeSense sensor for the rest. Integer arithmetic on tables: the same bytes on every platform.
class StructureSensor {
 public:
  StructureSensor(const Intrinsics& camera, const SensorDescription& sensor, std::uint64_t seed);

  /// Frame `number` of the scene; `depth` holds width · height values. No heap call.
  void measure(const DisparityImage& scene, std::int64_t number, std::span<std::uint16_t> depth);

 private:
  struct Deviation {
    std::int32_t fixed, flicker;  ///< eighths of a pixel, 8 fraction bits
  };
  /// Rows around the one being measured, and where the noise fields begin in it.
  struct Rows {
    const std::int32_t* above;  ///< two rows up
    const std::int32_t* just_above;
    const std::int32_t* here;
    const std::int32_t* just_below;
    const std::int32_t* below;  ///< two rows down
    std::uint32_t v;
    std::uint32_t key;  ///< of this row's per-pixel random numbers
  };

  void find_shadow(const std::int32_t* row, std::uint32_t key);
  /// What is matched at a pixel near a jump or on a steep surface; 0 = no match.
  [[nodiscard]] std::int32_t matched_at_edge(const Rows& rows, int u, int flicker, int fixed) const;
  [[nodiscard]] static int fixed_error(const std::int8_t* fixed_row, std::uint32_t u, std::int32_t disparity);

  int width_, height_;
  std::int32_t pixel_step_;     ///< disparity by which one pixel moves, fixed point
  std::int32_t steep_;          ///< change over four pixels from which matching suffers, fixed point
  std::uint32_t shadow_extra_;  ///< largest widening of a shadow, pixels, 8 fraction bits; a quarter to five
                                ///< quarters of it is used
  int last_column_;             ///< first one without readings
  std::uint32_t field_step_;    ///< noise field pixels per image pixel, 8 fraction bits
  std::uint64_t seed_;
  std::vector<std::uint16_t> millimetres_;  ///< by disparity in eighths of a pixel; 0 out of range
  std::vector<Deviation> deviation_;        ///< likewise
  std::vector<std::uint8_t> shadow_;        ///< of the row being measured
  NoiseField flicker_field_;
  /// Row by row, in each row one field after another: one for each whole pixel of disparity, in turn.
  std::vector<std::int8_t> fixed_fields_;
};

}  // namespace pliant::simulated
