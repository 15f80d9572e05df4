// The reference body.
#include "core/detect/descriptor_bounds.hpp"

namespace pliant {

void descriptor_bounds_scalar(const ShortForm* queries, const std::int16_t* candidates, std::size_t blocks,
                              std::int32_t* bounds, std::uint32_t* lead) noexcept {
  for (std::size_t q = 0; q < kBoundQueries; ++q) {
    std::int32_t most[kBoundLanes];
    for (std::size_t lane = 0; lane < kBoundLanes; ++lane) {
      most[lane] = INT32_MIN;
      lead[q * kBoundLanes + lane] = static_cast<std::uint32_t>(lane);
    }
    for (std::size_t block = 0; block < blocks; ++block) {
      const std::int16_t* pairs = candidates + block * kBoundLanes * kBoundNumbers;
      for (std::size_t lane = 0; lane < kBoundLanes; ++lane) {
        std::int32_t sum = 0;
        for (std::size_t k = 0; k < kBoundNumbers; ++k)
          sum += std::int32_t{queries[q].numbers[k]} * pairs[(k / 2 * kBoundLanes + lane) * 2 + k % 2];
        const std::size_t candidate = block * kBoundLanes + lane;
        bounds[q * blocks * kBoundLanes + candidate] = sum;
        if (sum > most[lane]) {
          most[lane] = sum;
          lead[q * kBoundLanes + lane] = static_cast<std::uint32_t>(candidate);
        }
      }
    }
  }
}

std::size_t select_bounds_scalar(const std::int32_t* bounds, std::size_t count, std::int32_t least,
                                 std::uint32_t* out) noexcept {
  std::size_t left = 0;
  for (std::size_t c = 0; c < count; ++c) {
    out[left] = static_cast<std::uint32_t>(c);
    left += bounds[c] >= least ? 1U : 0U;
  }
  return left;
}

void project_descriptor_scalar(const Descriptor& descriptor, const float* basis, float* along) noexcept {
  for (std::size_t k = 0; k < kBoundNumbers; ++k) along[k] = 0;
  for (std::size_t i = 0; i < kDescriptorSize; ++i) {
    const auto bin = static_cast<float>(descriptor.bins[i]);
    for (std::size_t k = 0; k < kBoundNumbers; ++k) along[k] += bin * basis[i * kBoundNumbers + k];
  }
}

}  // namespace pliant
