// Exact brute-force matching of 8-bit descriptors: a match is the largest dot product.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/descriptor_bounds.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"
#include "core/track_settings.hpp"

namespace pliant {

/// Dot products of a query with candidates[which[0 … count)], int16.
/// Formats: components int8 >= 0, norms squared <= Descriptor::kMostSquare, so that every dot product and
/// every partial sum of one is, too (Cauchy-Schwarz), and fits 16 bits; pairs of products stay <= 32,258. All
/// bodies give the same bits.
using DotKernel = void (*)(const Descriptor& query, const Descriptor* candidates, const std::uint32_t* which,
                           std::size_t count, std::int16_t* dots) noexcept;
inline constexpr std::size_t kDotGroup = 4;  ///< candidates that the wider bodies take at once

void dot_products_scalar(const Descriptor&, const Descriptor*, const std::uint32_t*, std::size_t,
                         std::int16_t*) noexcept;
void dot_products_sse41(const Descriptor&, const Descriptor*, const std::uint32_t*, std::size_t,
                        std::int16_t*) noexcept;
void dot_products_avx2(const Descriptor&, const Descriptor*, const std::uint32_t*, std::size_t,
                       std::int16_t*) noexcept;
void dot_products_avx512vnni(const Descriptor&, const Descriptor*, const std::uint32_t*, std::size_t,
                             std::int16_t*) noexcept;
void dot_products_neon(const Descriptor&, const Descriptor*, const std::uint32_t*, std::size_t,
                       std::int16_t*) noexcept;
void dot_products_dotprod(const Descriptor&, const Descriptor*, const std::uint32_t*, std::size_t,
                          std::int16_t*) noexcept;

/// The body for a setting on this CPU; the scalar one where the CPU lacks what is asked for.
[[nodiscard]] DotKernel dot_kernel(Kernels kernels) noexcept;

/// One correspondence between a scene and a model keypoint.
struct Match {
  std::uint16_t scene = 0;  ///< index of the scene keypoint
  std::uint16_t model = 0;  ///< index of the model keypoint
  std::int16_t dot = 0;     ///< dot product of their descriptors, about 127² for equal ones
};

/// Finds the best candidates of each query. Exact: the same as comparing every query with every candidate.
/// Bounds from a tenth of the numbers leave some hundredths of the candidates to be compared in full; when
/// all are alike, nothing is left out, and the bounds are what it costs more.
class DescriptorMatcher {
 public:
  static constexpr std::size_t kMostBest = 8;

  /// Takes the memory for up to `candidates` candidates.
  void lay_out(Workspace& workspace, std::size_t candidates) noexcept;
  void start(Kernels kernels) noexcept;
  /// Takes memory to work with a matcher's candidates beside it (see join()).
  void lay_out_helper(Workspace& workspace, std::size_t candidates) noexcept;
  /// A helper matches against what `prepared` was prepared with, at the same time as others do.
  void join(const DescriptorMatcher& prepared) noexcept;

  /// Sets the candidates (the model's descriptors, which must outlive the matching); those beyond the
  /// capacity are not looked at.
  void prepare(std::span<const Descriptor> candidates) noexcept;

  /// The `best` (at most kMostBest) candidates of each of queries [0, queries.size()): matches[q * best + k],
  /// best first, of equals the lowest index. With fewer candidates than `best`, the last is repeated.
  void match(std::span<const Descriptor> queries, std::size_t best, std::span<Match> matches) noexcept;

 private:
  struct Best;
  void compare(const Descriptor& query, std::span<const std::uint32_t> which, Best& best) const noexcept;

  DotKernel kernel_ = &dot_products_scalar;
  DescriptorBounds close_;
  std::span<const Descriptor> candidates_;
  std::span<std::int32_t> bounds_;
  std::span<std::uint32_t> left_;  // candidates that may be among the best
  std::span<Descriptor> padded_;   // queries of an incomplete group
};

}  // namespace pliant
