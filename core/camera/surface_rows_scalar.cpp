// The reference bodies.
#include "core/camera/surface_rows.hpp"

namespace pliant {

namespace {

void convert(const std::uint16_t* raw, std::uint16_t* out, std::size_t count,
             const DepthScale& scale) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t reading = raw[i];
    out[i] = reading >= scale.first && reading <= scale.last
                 ? static_cast<std::uint16_t>((reading * scale.multiplier + scale.half) >> scale.shift)
                 : std::uint16_t{0};
  }
}

/// Adds up how many of three pixels lie within `limit` of `z`, and their differences.
struct Support {
  std::int32_t count = 0, sum = 0;

  void add(const std::uint16_t* line, std::int32_t z, std::int32_t limit) noexcept {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t difference = line[k] - z;
      if (difference > limit || difference < -limit) continue;
      ++count;
      sum += difference;
    }
  }
};

Support support_of(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                   std::size_t i, const DiscontinuityRule& rule) noexcept {
  const std::int32_t z = row[i], limit = rule.limit(row[i]);
  Support support;  // the pixel counts itself
  support.add(above + i - 1, z, limit);
  support.add(row + i - 1, z, limit);
  support.add(below + i - 1, z, limit);
  return support;
}

void clean(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
           std::uint16_t* out, std::size_t count, const DiscontinuityRule& rule) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const bool keep = row[i] != 0 && support_of(above, row, below, i, rule).count > kMinSupport;
    out[i] = keep ? row[i] : std::uint16_t{0};
  }
}

void smooth(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
            std::uint16_t* out, std::size_t count, const DiscontinuityRule& rule) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = row[i];
    if (row[i] == 0) continue;
    const Support support = support_of(above, row, below, i, rule);
    if (support.count < 2) continue;
    const std::int32_t reciprocal = kMeanReciprocal[support.count - 2];
    out[i] = static_cast<std::uint16_t>(row[i] + ((support.sum * reciprocal + (1 << 14)) >> 15));
  }
}

}  // namespace

const SurfaceRows kSurfaceRowsScalar = {&convert, &clean, &smooth};

}  // namespace pliant
