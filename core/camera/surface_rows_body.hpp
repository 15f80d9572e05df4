// The bodies of surface_rows.hpp over a lane type of core/simd. Same formats and bounds as the reference; the
// sums of the smoothing wrap in 16 bits, which their differences fit. Include only from files built for the
// lane type's instruction set.
#pragma once

#include "core/camera/surface_rows.hpp"

namespace pliant {

template <typename L>
struct SurfaceRowsBody {
  using Lanes = typename L::Lanes;

  static void convert(const std::uint16_t* raw, std::uint16_t* out, std::size_t count,
                      const DepthScale& scale) noexcept {
    if (count < L::kCount) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t reading = raw[i];
        out[i] = reading >= scale.first && reading <= scale.last
                     ? static_cast<std::uint16_t>((reading * scale.multiplier + scale.half) >> scale.shift)
                     : std::uint16_t{0};
      }
      return;
    }
    const Lanes first = L::all(scale.first), last = L::all(scale.last);
    for (std::size_t i = 0;;) {
      const Lanes reading = L::load(raw + i);
      const Lanes usable = L::both(L::at_most(first, reading), L::at_most(reading, last));
      L::store(out + i, L::scale(L::both(reading, usable), scale.multiplier, scale.half, scale.shift));
      if (i + L::kCount >= count) return;
      i += L::kCount;
      if (i + L::kCount > count)
        i = count - L::kCount;  // the last lanes once more: no reading beyond the row
    }
  }

  static void clean(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                    std::uint16_t* out, std::size_t count, const DiscontinuityRule& rule) noexcept {
    const Limits limits(rule);
    const Lanes fewest = L::all(kMinSupport);
    for (std::size_t i = 0; i < count; i += L::kCount) {
      const Lanes z = L::load(row + i);
      const typename L::Band band = L::band(z, limits.at(z));
      Lanes number = L::zero();  // a mask of all ones is -1
      const auto look = [&](const std::uint16_t* at) {
        number = L::subtract(number, L::inside(L::load(at), band));
      };
      look(above + i - 1);
      look(above + i);
      look(above + i + 1);
      look(row + i - 1);
      look(row + i + 1);
      look(below + i - 1);
      look(below + i);
      look(below + i + 1);
      L::store(out + i, L::both(z, L::at_most(fewest, number)));
    }
  }

  static void smooth(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                     std::uint16_t* out, std::size_t count, const DiscontinuityRule& rule) noexcept {
    const Limits limits(rule);
    const Lanes one = L::all(1);
    for (std::size_t i = 0; i < count; i += L::kCount) {
      const Lanes z = L::load(row + i);
      const typename L::Band band = L::band(z, limits.at(z));
      Lanes number = L::zero(), sum = L::zero();
      const auto look = [&](const std::uint16_t* at) {
        const Lanes a = L::load(at), mask = L::inside(a, band);
        number = L::subtract(number, mask);
        sum = L::add(sum, L::both(a, mask));
      };
      look(above + i - 1);
      look(above + i);
      look(above + i + 1);
      look(row + i - 1);
      look(row + i + 1);
      look(below + i - 1);
      look(below + i);
      look(below + i + 1);
      const Lanes differences = L::subtract(sum, L::low_product(number, z));
      // without the pixel itself `number` is one less than the mean's n, whose table begins at 2
      const Lanes reciprocal = L::look_up(kMeanReciprocal, L::subtract(number, one));
      L::store(out + i, L::add(z, L::rounded_product(differences, reciprocal)));
    }
  }

 private:
  /// DiscontinuityRule::limit().
  struct Limits {
    Lanes base, slope, growth, centre, most, one;
    int shift;

    explicit Limits(const DiscontinuityRule& rule) noexcept
        : base(L::all(rule.base)),
          slope(L::all(rule.slope)),
          growth(L::all(rule.growth)),
          centre(L::all(DiscontinuityRule::kNoiseCentre)),
          most(L::all(DiscontinuityRule::kMost)),
          one(L::all(1)),
          shift(rule.growth_shift) {}
    Lanes at(Lanes z) const noexcept {
      const Lanes off = L::distance(z, centre);
      const Lanes noise = L::lesser(L::high_product(L::high_product(off, off), growth), most);
      const Lanes sum =
          L::add_saturated(L::add_saturated(base, L::high_product(z, slope)), L::shift_left(noise, shift));
      return L::lesser(L::lesser(sum, most), L::subtract_saturated(z, one));
    }
  };
};

}  // namespace pliant
