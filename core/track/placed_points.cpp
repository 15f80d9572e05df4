#include "core/track/placed_points.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace pliant {

namespace {

/// Points [begin, end), one by one.
void place_each(const PointColumns& from, std::size_t begin, std::size_t end, const FixedPose& pose,
                PlacedPoints& out) noexcept {
  // 16 bits each, as Q14 of a rotation fits: products of 16 bits are what vectors multiply best.
  std::array<std::int16_t, 9> r{};
  for (std::size_t k = 0; k < r.size(); ++k) r[k] = static_cast<std::int16_t>(pose.r[k]);
  const auto turn = [&](const std::int16_t* from_x, const std::int16_t* from_y, const std::int16_t* from_z,
                        std::size_t row, std::int32_t shift, std::int32_t* to) {
    const std::int16_t a = r[row], b = r[row + 1], c = r[row + 2];
    for (std::size_t k = begin; k < end; ++k)
      to[k] = ((a * from_x[k] + b * from_y[k] + c * from_z[k] + 8192) >> 14) + shift;
  };
  turn(from.x, from.y, from.z, 0, pose.t[0], out.x.data());
  turn(from.x, from.y, from.z, 3, pose.t[1], out.y.data());
  turn(from.x, from.y, from.z, 6, pose.t[2], out.z.data());
  turn(from.nx, from.ny, from.nz, 0, 0, out.nx.data());
  turn(from.nx, from.ny, from.nz, 3, 0, out.ny.data());
  turn(from.nx, from.ny, from.nz, 6, 0, out.nz.data());
  for (std::size_t k = begin; k < end; ++k) out.side[k] = side_of(out.point(k), out.normal(k));
}

#if defined(__SSE2__)

/// Eight numbers of 32 bits.
struct Eight {
  __m128i low, high;

  [[nodiscard]] __m128i narrowed() const noexcept { return _mm_packs_epi32(low, high); }
};

/// Eight vectors of 16 bits as pairs, whose products are added: (x y) and (z w).
struct EightVectors {
  Eight xy, zw;

  EightVectors(__m128i x, __m128i y, __m128i z, __m128i w) noexcept
      : xy{_mm_unpacklo_epi16(x, y), _mm_unpackhi_epi16(x, y)},
        zw{_mm_unpacklo_epi16(z, w), _mm_unpackhi_epi16(z, w)} {}
};

Eight dot(const EightVectors& a, const EightVectors& b) noexcept {
  return {_mm_add_epi32(_mm_madd_epi16(a.xy.low, b.xy.low), _mm_madd_epi16(a.zw.low, b.zw.low)),
          _mm_add_epi32(_mm_madd_epi16(a.xy.high, b.xy.high), _mm_madd_epi16(a.zw.high, b.zw.high))};
}

__m128i eight_of(const std::int16_t* from) noexcept {
  return _mm_loadu_si128(static_cast<const __m128i*>(static_cast<const void*>(from)));
}

void store(const Eight& from, std::int32_t* to) noexcept {
  auto* const at = static_cast<__m128i*>(static_cast<void*>(to));
  _mm_storeu_si128(at, from.low);
  _mm_storeu_si128(at + 1, from.high);
}

/// A pose as products of pairs take it: rows of the rotation with what rounds, and the shift.
struct EightPoses {
  __m128i xy[3], zw[3], shift[3];

  explicit EightPoses(const FixedPose& pose) noexcept {
    for (std::size_t row = 0; row < 3; ++row) {
      const auto pair = [](std::int32_t low, std::int32_t high) {
        return _mm_set1_epi32(static_cast<std::int32_t>((static_cast<std::uint32_t>(high) << 16) |
                                                        (static_cast<std::uint32_t>(low) & 0xFFFF)));
      };
      xy[row] = pair(pose.r[3 * row], pose.r[3 * row + 1]);
      zw[row] = pair(pose.r[3 * row + 2], 8192);
      shift[row] = _mm_set1_epi32(pose.t[row]);
    }
  }
  /// A coordinate of eight vectors whose fourth number is 1, turned.
  [[nodiscard]] Eight turned(std::size_t row, const EightVectors& v) const noexcept {
    const auto sum = [&](__m128i of_xy, __m128i of_zw) {
      return _mm_srai_epi32(_mm_add_epi32(_mm_madd_epi16(xy[row], of_xy), _mm_madd_epi16(zw[row], of_zw)),
                            14);
    };
    return {sum(v.xy.low, v.zw.low), sum(v.xy.high, v.zw.high)};
  }
  [[nodiscard]] Eight moved(std::size_t row, const EightVectors& v) const noexcept {
    const Eight at = turned(row, v);
    return {_mm_add_epi32(at.low, shift[row]), _mm_add_epi32(at.high, shift[row])};
  }
};

/// As faces_camera() and on_rim() tell. What lies beyond 32 m, where 16 bits end, nobody asks of.
Eight sides(const Eight& x, const Eight& y, const Eight& z, const EightVectors& normals) noexcept {
  const __m128i none = _mm_setzero_si128();
  const auto sixteenth = [](const Eight& a) {
    return Eight{_mm_srai_epi32(a.low, 4), _mm_srai_epi32(a.high, 4)}.narrowed();
  };
  const __m128i depth = sixteenth(z);
  const Eight away = dot(normals, EightVectors(sixteenth(x), sixteenth(y), depth, none));
  const EightVectors cosines(_mm_set1_epi16(kCos75), none, _mm_set1_epi16(kCos80), none);
  const auto side = [&](__m128i turned_away, __m128i depths, __m128i cos75, __m128i cos80) {
    const __m128i sign = _mm_srai_epi32(turned_away, 31);
    const __m128i size = _mm_srai_epi32(_mm_sub_epi32(_mm_xor_si128(turned_away, sign), sign), 14);
    const __m128i facing =
        _mm_and_si128(sign, _mm_cmpgt_epi32(size, _mm_srai_epi32(_mm_madd_epi16(depths, cos75), 14)));
    const __m128i rim = _mm_andnot_si128(
        _mm_cmpgt_epi32(size, _mm_srai_epi32(_mm_madd_epi16(depths, cos80), 14)), _mm_set1_epi32(1));
    return _mm_or_si128(_mm_and_si128(facing, _mm_set1_epi32(2)), _mm_andnot_si128(facing, rim));
  };
  return {side(away.low, _mm_unpacklo_epi16(depth, none), cosines.xy.low, cosines.zw.low),
          side(away.high, _mm_unpackhi_epi16(depth, none), cosines.xy.high, cosines.zw.high)};
}

void place_eight(const PointColumns& from, std::size_t k, const EightPoses& poses,
                 PlacedPoints& out) noexcept {
  static_assert(static_cast<int>(Side::away) == 0 && static_cast<int>(Side::rim) == 1 &&
                static_cast<int>(Side::facing) == 2);
  const __m128i one = _mm_set1_epi16(1);
  const EightVectors points(eight_of(from.x + k), eight_of(from.y + k), eight_of(from.z + k), one),
      directions(eight_of(from.nx + k), eight_of(from.ny + k), eight_of(from.nz + k), one);
  const Eight x = poses.moved(0, points), y = poses.moved(1, points), z = poses.moved(2, points);
  const Eight nx = poses.turned(0, directions), ny = poses.turned(1, directions),
              nz = poses.turned(2, directions);
  store(x, &out.x[k]);
  store(y, &out.y[k]);
  store(z, &out.z[k]);
  store(nx, &out.nx[k]);
  store(ny, &out.ny[k]);
  store(nz, &out.nz[k]);
  const EightVectors normals(nx.narrowed(), ny.narrowed(), nz.narrowed(), _mm_setzero_si128());
  const Eight side = sides(x, y, z, normals);
  auto* const at = static_cast<__m128i*>(static_cast<void*>(&out.side[k]));
  _mm_storeu_si128(at, side.low);
  _mm_storeu_si128(at + 1, side.high);
}

#endif

}  // namespace

void PlacedPoints::place(const PointColumns& from, std::size_t count, const FixedPose& pose) noexcept {
  std::size_t begin = 0;
#if defined(__SSE2__)
  const EightPoses poses(pose);
  for (; begin + 8 <= count; begin += 8) place_eight(from, begin, poses, *this);
#endif
  if (begin < count) place_each(from, begin, count, pose, *this);
}

}  // namespace pliant
