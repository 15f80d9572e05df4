// Upper bounds of dot products of descriptors, from 48 numbers a descriptor instead of 352: what lets an
// exact search pass over nearly all candidates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"
#include "core/track_settings.hpp"

namespace pliant {

inline constexpr std::size_t kBoundNumbers = 48;  ///< a descriptor's short form: 47 coordinates and a length
inline constexpr std::size_t kBoundLanes = 16;    ///< candidates in a block
inline constexpr std::size_t kBoundQueries = 4;   ///< queries a call

/// Short form of a descriptor. With an orthonormal basis of some 47-dimensional subspace, a descriptor is its
/// coordinates there and a rest across; by the Cauchy-Schwarz inequality a dot product is at most the dot
/// product of the coordinates plus the product of the rests' lengths, and so a dot product of 48 numbers.
/// Format: 1/kBoundScale of a descriptor's unit, int16, |x| <= 136.4 · 32 + 1; clamped to 6688, so that no
/// sum can overflow whatever a damaged descriptor holds.
struct ShortForm {
  std::int16_t numbers[kBoundNumbers];
};
inline constexpr int kBoundScale = 32;
/// What a bound may fall short by, in descriptor units squared: the coordinates are off by half of 1/32 each
/// (together 0.107 of a length up to 136.4, on both sides: 29.3), and by the rounding of the float sums
/// (5.5).
inline constexpr int kBoundSlack = 36;

/// bounds[q * kBoundLanes * blocks + c] of kBoundQueries queries with the candidates of `blocks` blocks,
/// where a block holds for each pair of numbers (0, 1), (2, 3), … the pairs of its kBoundLanes candidates.
/// lead[q * kBoundLanes + lane]: the candidate with the largest bound among those at this lane, the first of
/// equals. Format: int32, sums <= 1.9e7 (Cauchy-Schwarz). All bodies give the same bits.
using BoundKernel = void (*)(const ShortForm* queries, const std::int16_t* candidates, std::size_t blocks,
                             std::int32_t* bounds, std::uint32_t* lead) noexcept;

void descriptor_bounds_scalar(const ShortForm*, const std::int16_t*, std::size_t, std::int32_t*,
                              std::uint32_t*) noexcept;
void descriptor_bounds_sse41(const ShortForm*, const std::int16_t*, std::size_t, std::int32_t*,
                             std::uint32_t*) noexcept;
void descriptor_bounds_avx2(const ShortForm*, const std::int16_t*, std::size_t, std::int32_t*,
                            std::uint32_t*) noexcept;
void descriptor_bounds_avx512vnni(const ShortForm*, const std::int16_t*, std::size_t, std::int32_t*,
                                  std::uint32_t*) noexcept;
void descriptor_bounds_neon(const ShortForm*, const std::int16_t*, std::size_t, std::int32_t*,
                            std::uint32_t*) noexcept;

/// The indices of those of bounds[0 … count) that are at least `least`, in order; returns how many. `out` has
/// room for count + kBoundLanes.
using SelectKernel = std::size_t (*)(const std::int32_t* bounds, std::size_t count, std::int32_t least,
                                     std::uint32_t* out) noexcept;
std::size_t select_bounds_scalar(const std::int32_t*, std::size_t, std::int32_t, std::uint32_t*) noexcept;
std::size_t select_bounds_avx2(const std::int32_t*, std::size_t, std::int32_t, std::uint32_t*) noexcept;
std::size_t select_bounds_avx512vnni(const std::int32_t*, std::size_t, std::int32_t, std::uint32_t*) noexcept;

/// along[k] = the sum over the bins of bin · basis[bin][k], bin after bin in float: every body adds in the
/// same order and gives the same bits.
using ProjectKernel = void (*)(const Descriptor& descriptor, const float* basis, float* along) noexcept;
void project_descriptor_scalar(const Descriptor&, const float*, float*) noexcept;
void project_descriptor_avx2(const Descriptor&, const float*, float*) noexcept;
void project_descriptor_avx512vnni(const Descriptor&, const float*, float*) noexcept;

/// The bodies for a setting on this CPU.
struct BoundKernels {
  BoundKernel bounds = &descriptor_bounds_scalar;
  SelectKernel select = &select_bounds_scalar;
  ProjectKernel project = &project_descriptor_scalar;
};
[[nodiscard]] BoundKernels bound_kernels(Kernels kernels) noexcept;

/// The basis that suits a set of candidates, and their short forms in blocks.
class DescriptorBounds {
 public:
  /// Takes the memory for up to `candidates` candidates.
  void lay_out(Workspace& workspace, std::size_t candidates) noexcept;
  void start(Kernels kernels) noexcept { kernels_ = bound_kernels(kernels); }

  /// Learns the basis from up to 512 of the candidates (the subspace in which they differ most) and brings
  /// all of them to short form. Any basis gives valid bounds; this one gives close ones.
  void build(std::span<const Descriptor> candidates) noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  [[nodiscard]] std::size_t padded_size() const noexcept { return blocks() * kBoundLanes; }

  /// Bounds as the kernel gives them, for kBoundQueries queries; candidates beyond size() in the last block
  /// have the bound 0.
  void bounds(const Descriptor* queries, std::int32_t* bounds, std::uint32_t* lead) const noexcept;

  /// The candidates whose bound (from bounds(), of one query) is at least that of this dot product, in order.
  /// `out` has room for padded_size() + kBoundLanes.
  [[nodiscard]] std::size_t select(const std::int32_t* bounds, int dot, std::uint32_t* out) const noexcept {
    return kernels_.select(bounds, count_, least_bound(dot), out);
  }
  /// The least bound that a candidate with this dot product can have.
  [[nodiscard]] static std::int32_t least_bound(int dot) noexcept {
    return (dot - kBoundSlack) * kBoundScale * kBoundScale;
  }

 private:
  [[nodiscard]] std::size_t blocks() const noexcept { return (count_ + kBoundLanes - 1) / kBoundLanes; }
  [[nodiscard]] ShortForm short_form(const Descriptor& descriptor) const noexcept;
  void orthonormalise() noexcept;

  BoundKernels kernels_;
  std::span<float> basis_;    // [bin][number], the last number of each bin 0
  std::span<float> product_;  // the same
  std::span<std::int16_t> forms_;
  std::size_t count_ = 0;
};

}  // namespace pliant
