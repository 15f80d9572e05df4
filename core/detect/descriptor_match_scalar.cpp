// The reference body.
#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_scalar(const Descriptor* queries, const Descriptor* candidates, std::size_t count,
                         std::int16_t* dots) noexcept {
  for (std::size_t q = 0; q < kDotQueries; ++q)
    for (std::size_t c = 0; c < count; ++c) {
      std::int32_t sum = 0;
      for (std::size_t i = 0; i < kDescriptorSize; ++i)
        sum += std::int32_t{queries[q].bins[i]} * candidates[c].bins[i];
      dots[q * count + c] = static_cast<std::int16_t>(sum);
    }
}

}  // namespace pliant
