#include "core/detect/descriptor_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "core/simd/cpu.hpp"

namespace pliant {

namespace {

constexpr std::size_t kCoordinates = kBoundNumbers - 1;
constexpr std::size_t kSample = 512;  // candidates from which the basis is learnt
constexpr int kIterations = 5;        // of the subspace iteration

/// sums[k] += factor · row[k] over the numbers of a bin: element by element, so that any vector width gives
/// the same bits.
void add_row(float factor, const float* row, float* sums) noexcept {
  for (std::size_t k = 0; k < kBoundNumbers; ++k) sums[k] += factor * row[k];
}

std::int16_t to_number(float x) noexcept {
  return static_cast<std::int16_t>(std::floor(std::clamp(x, -6688.0F, 6688.0F)));
}

}  // namespace

BoundKernels bound_kernels(Kernels kernels) noexcept {
  switch (simd_body(kernels)) {
#if defined(__x86_64__) || defined(__i386__)
    case SimdBody::avx2:
      if (kernels == Kernels::automatic && cpu_features().avx512vnni)
        return {&descriptor_bounds_avx512vnni, &select_bounds_avx512vnni, &project_descriptor_avx512vnni};
      return {&descriptor_bounds_avx2, &select_bounds_avx2, &project_descriptor_avx2};
    case SimdBody::sse41:
      return {&descriptor_bounds_sse41, &select_bounds_scalar, &project_descriptor_scalar};
#elif defined(__aarch64__) || defined(__arm__)
    case SimdBody::neon:
      return {&descriptor_bounds_neon, &select_bounds_scalar, &project_descriptor_scalar};
#endif
    default:
      return {};
  }
}

void DescriptorBounds::lay_out(Workspace& workspace, std::size_t candidates) noexcept {
  basis_ = workspace.take<float>(kDescriptorSize * kBoundNumbers);
  product_ = workspace.take<float>(kDescriptorSize * kBoundNumbers);
  forms_ = workspace.take<std::int16_t>((candidates + kBoundLanes - 1) / kBoundLanes * kBoundLanes *
                                        kBoundNumbers);
  count_ = 0;
}

void DescriptorBounds::orthonormalise() noexcept {
  // Gram-Schmidt, each coordinate twice: orthogonal to float's last digits.
  for (std::size_t k = 0; k < kBoundNumbers; ++k) {
    double before = 0;
    for (int pass = 0; pass < 2; ++pass) {
      float along[kBoundNumbers] = {};
      for (std::size_t i = 0; i < kDescriptorSize; ++i)
        add_row(basis_[i * kBoundNumbers + k], &basis_[i * kBoundNumbers], along);
      if (pass == 0) before = static_cast<double>(along[k]);
      for (std::size_t i = 0; i < kDescriptorSize; ++i) {
        float* row = &basis_[i * kBoundNumbers];
        float sum = 0;
        for (std::size_t j = 0; j < k; ++j) sum += along[j] * row[j];
        row[k] -= sum;
      }
    }
    double square = 0;
    for (std::size_t i = 0; i < kDescriptorSize; ++i) {
      const double x = static_cast<double>(basis_[i * kBoundNumbers + k]);
      square += x * x;
    }
    // What depends on the coordinates before it says nothing more: left out. So is the last number.
    const bool counts = k < kCoordinates && square > 1e-6 * before && square > 0;
    const auto scale = static_cast<float>(counts ? 1 / std::sqrt(square) : 0);
    for (std::size_t i = 0; i < kDescriptorSize; ++i) basis_[i * kBoundNumbers + k] *= scale;
  }
}

void DescriptorBounds::build(std::span<const Descriptor> candidates) noexcept {
  const std::size_t most = forms_.size() / kBoundNumbers;
  count_ = std::min(candidates.size(), most);
  if (count_ == 0) return;
  const std::size_t sample = std::min(count_, kSample);
  const auto sampled = [&](std::size_t k) -> const Descriptor& { return candidates[k * count_ / sample]; };
  for (float& b : basis_) b = 0;
  for (std::size_t k = 0; k < sample; ++k)
    for (std::size_t i = 0; i < kDescriptorSize; ++i)
      basis_[i * kBoundNumbers + k % kCoordinates] += static_cast<float>(sampled(k).bins[i]);
  orthonormalise();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (float& p : product_) p = 0;
    for (std::size_t k = 0; k < sample; ++k) {
      const Descriptor& d = sampled(k);
      float along[kBoundNumbers];
      kernels_.project(d, basis_.data(), along);
      for (std::size_t i = 0; i < kDescriptorSize; ++i)
        if (d.bins[i] != 0) add_row(d.bins[i], along, &product_[i * kBoundNumbers]);
    }
    for (std::size_t i = 0; i < basis_.size(); ++i) basis_[i] = product_[i];
    orthonormalise();
  }
  for (std::size_t c = 0; c < padded_size(); ++c) {
    const ShortForm form = c < count_ ? short_form(candidates[c]) : ShortForm{};
    std::int16_t* block = &forms_[c / kBoundLanes * kBoundLanes * kBoundNumbers];
    for (std::size_t k = 0; k < kBoundNumbers; ++k)
      block[(k / 2 * kBoundLanes + c % kBoundLanes) * 2 + k % 2] = form.numbers[k];
  }
}

ShortForm DescriptorBounds::short_form(const Descriptor& descriptor) const noexcept {
  float along[kBoundNumbers];
  kernels_.project(descriptor, basis_.data(), along);
  std::int32_t square = 0;
  for (const std::int32_t bin : descriptor.bins) square += bin * bin;
  ShortForm form;
  float rest = static_cast<float>(square);
  for (std::size_t k = 0; k < kCoordinates; ++k) {
    rest -= along[k] * along[k];
    form.numbers[k] = to_number(along[k] * kBoundScale + 0.5F);
  }
  // Upwards: a longer rest only widens the bound. Half a unit covers the rounding of the squares.
  form.numbers[kCoordinates] = to_number(std::sqrt(std::max(rest, 0.0F) + 0.5F) * kBoundScale + 1);
  return form;
}

void DescriptorBounds::bounds(const Descriptor* queries, std::int32_t* bounds,
                              std::uint32_t* lead) const noexcept {
  ShortForm forms[kBoundQueries];
  for (std::size_t q = 0; q < kBoundQueries; ++q) forms[q] = short_form(queries[q]);
  kernels_.bounds(forms, forms_.data(), blocks(), bounds, lead);
}

}  // namespace pliant
