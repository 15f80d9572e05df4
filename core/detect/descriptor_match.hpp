// Exact brute-force matching of 8-bit descriptors: a match is the largest dot product.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"
#include "core/track_settings.hpp"

namespace pliant {

/// Dot products of kDotQueries queries with `count` candidates: dots[q * count + c], int16.
/// Formats: components int8 >= 0, norms <= 136.4 (127 and the rounding of 352 components), so that every dot
/// product and every partial sum of one is <= 18,605 and fits 16 bits; pairs of products stay <= 32,258. All
/// bodies give the same bits.
using DotKernel = void (*)(const Descriptor* queries, const Descriptor* candidates, std::size_t count,
                           std::int16_t* dots) noexcept;
inline constexpr std::size_t kDotQueries = 4;

void dot_products_scalar(const Descriptor*, const Descriptor*, std::size_t, std::int16_t*) noexcept;
void dot_products_sse41(const Descriptor*, const Descriptor*, std::size_t, std::int16_t*) noexcept;
void dot_products_avx2(const Descriptor*, const Descriptor*, std::size_t, std::int16_t*) noexcept;
void dot_products_avx512vnni(const Descriptor*, const Descriptor*, std::size_t, std::int16_t*) noexcept;
void dot_products_neon(const Descriptor*, const Descriptor*, std::size_t, std::int16_t*) noexcept;
void dot_products_dotprod(const Descriptor*, const Descriptor*, std::size_t, std::int16_t*) noexcept;

/// The body for a setting on this CPU; the scalar one where the CPU lacks what is asked for.
[[nodiscard]] DotKernel dot_kernel(Kernels kernels) noexcept;

/// One correspondence between a scene and a model keypoint.
struct Match {
  std::uint16_t scene = 0;  ///< index of the scene keypoint
  std::uint16_t model = 0;  ///< index of the model keypoint
  std::int16_t dot = 0;     ///< dot product of their descriptors, about 127² for equal ones
  std::int16_t second = 0;  ///< dot product of the next best candidate, for the ratio test
};

/// Finds the best candidates of each query.
class DescriptorMatcher {
 public:
  static constexpr std::size_t kMostBest = 8;

  /// Takes the memory for up to `candidates` candidates.
  void lay_out(Workspace& workspace, std::size_t candidates) noexcept;
  void start(Kernels kernels) noexcept { kernel_ = dot_kernel(kernels); }

  /// The `best` (at most kMostBest) candidates of each of queries [0, queries.size()): matches[q * best + k],
  /// best first, of equals the lowest index; `second` is the dot product of the next one behind, 0 for none.
  /// With fewer candidates than `best`, the last is repeated. Candidates beyond the capacity are not looked
  /// at.
  void match(std::span<const Descriptor> queries, std::span<const Descriptor> candidates, std::size_t best,
             std::span<Match> matches) noexcept;

 private:
  DotKernel kernel_ = &dot_products_scalar;
  std::span<std::int16_t> dots_;
  std::span<Descriptor> padded_;
};

}  // namespace pliant
