// The reference body.
#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_scalar(const Descriptor& query, const Descriptor* candidates, const std::uint32_t* which,
                         std::size_t count, std::int16_t* dots) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < kDescriptorSize; ++i)
      sum += std::int32_t{query.bins[i]} * candidates[which[k]].bins[i];
    dots[k] = static_cast<std::int16_t>(sum);
  }
}

}  // namespace pliant
