#include "drivers/simulated/noise_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/simulated/hash_random.hpp"

namespace pliant::simulated {

namespace {

using Plane = std::vector<std::int64_t>;

Plane white(std::uint32_t size, std::uint64_t seed) {
  Plane plane(static_cast<std::size_t>(size) * size);
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = gaussian(seed, i);
  return plane;
}

/// Binomial blur [1 2 1] in both directions, `times` over; variance of the kernel is times / 2.
Plane blurred(Plane plane, std::uint32_t size, int times) {
  Plane next(plane.size());
  const std::uint32_t mask = size - 1;
  for (int pass = 0; pass < 2 * times; ++pass) {
    const bool along_u = pass % 2 == 0;
    for (std::uint32_t v = 0; v < size; ++v)
      for (std::uint32_t u = 0; u < size; ++u) {
        const auto at = [&](std::uint32_t step) {
          return along_u ? plane[v * size + ((u + step) & mask)] : plane[((v + step) & mask) * size + u];
        };
        next[v * size + u] = (at(mask) + 2 * at(0) + at(1)) / 4;
      }
    std::swap(plane, next);
  }
  return plane;
}

double deviation(const Plane& plane) {
  double sum = 0;
  for (const std::int64_t x : plane) sum += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(sum / static_cast<double>(plane.size()));
}

}  // namespace

NoiseField::NoiseField(std::uint32_t size, std::uint64_t seed)
    : mask_(size - 1), values_(static_cast<std::size_t>(size) * size) {
  // Seven tenths of the variance varies over a pixel or two, three tenths over five.
  const Plane fine = blurred(white(size, mixed(seed, 1)), size, 2);
  const Plane coarse = blurred(white(size, mixed(seed, 2)), size, 14);
  const double fine_scale = kDeviation * std::sqrt(0.7) / deviation(fine);
  const double coarse_scale = kDeviation * std::sqrt(0.3) / deviation(coarse);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const double value =
        fine_scale * static_cast<double>(fine[i]) + coarse_scale * static_cast<double>(coarse[i]);
    values_[i] = static_cast<std::int8_t>(std::clamp(std::floor(value + 0.5), -127.0, 127.0));
  }
}

}  // namespace pliant::simulated
