#include "core/detect/shot_histogram.hpp"

#include <cmath>
#include <cstring>

// Before a loop: its rounds do not read what others write.
#ifdef __clang__
#define PLIANT_INDEPENDENT_ROUNDS _Pragma("clang loop vectorize(assume_safety)")
#else
#define PLIANT_INDEPENDENT_ROUNDS _Pragma("GCC ivdep")
#endif

namespace pliant {

namespace {

constexpr std::int32_t kCosineBins = 11;
constexpr std::int32_t kAzimuths = 8;
constexpr std::int32_t kShells = 4;  // elevation × radius
using Shells [[gnu::vector_size(kShells * sizeof(float))]] = float;
constexpr float kAtCentre = 1e-4F;  // a point this near to the keypoint has no direction

float clamp01(float x) noexcept {
  x = x < 0 ? 0 : x;
  return x > 1 ? 1 : x;
}

/// Angle of (x, y) in eighths of a turn, [0, 8): atan(t) ~ t·π/4 + 0.273·t·(1 − t), off by less than 0.22°
/// (Rajan et al., Efficient approximations for the arctangent function, IEEE SPM 2006, eq. 9). All choices
/// are between values at hand, so that lanes need no jump.
float azimuth_of(float x, float y) noexcept {
  const float ax = std::fabs(x), ay = std::fabs(y);
  const float high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
  const float t = low / (high > 1e-30F ? high : 1e-30F);
  float angle = t + 0.3476F * t * (1 - t);
  const float over_diagonal = 2 - angle;
  angle = ay > ax ? over_diagonal : angle;
  const float left = 4 - angle;
  angle = x < 0 ? left : angle;
  const float below = 8 - angle;
  angle = y < 0 ? below : angle;
  return angle < 8 ? angle : 0;
}

}  // namespace

void ShotBins::lay_out(Workspace& workspace, std::size_t most_points) noexcept {
  const std::size_t room = most_points + kLanes;
  azimuth_bin_ = workspace.take<std::int32_t>(room);
  cosine_bin_ = workspace.take<std::int32_t>(room);
  azimuth_part_ = workspace.take<float>(room);
  cosine_part_ = workspace.take<float>(room);
  up_ = workspace.take<float>(room);
  outer_ = workspace.take<float>(room);
  weight_ = workspace.take<float>(room);
}

void ShotBins::place(const ShotPoints& points) noexcept {
  const float xx = points.axes[0], xy = points.axes[1], xz = points.axes[2];
  const float yx = points.axes[3], yy = points.axes[4], yz = points.axes[5];
  const float zx = points.axes[6], zy = points.axes[7], zz = points.axes[8];
  const std::size_t count = (points.count + kLanes - 1) / kLanes * kLanes;
  const float *px = points.x.data(), *py = points.y.data(), *pz = points.z.data();
  const float *nx = points.nx.data(), *ny = points.ny.data(), *nz = points.nz.data();
  const float* distance = points.distance.data();
  std::int32_t *azimuth_bin = azimuth_bin_.data(), *cosine_bin = cosine_bin_.data();
  float *azimuth_part = azimuth_part_.data(), *cosine_part = cosine_part_.data();
  float *up = up_.data(), *outer = outer_.data(), *weight = weight_.data();
  PLIANT_INDEPENDENT_ROUNDS
  for (std::size_t k = 0; k < count; ++k) {
    const float cosine = zx * nx[k] + zy * ny[k] + zz * nz[k];
    const float cosine_at = clamp01(0.5F * cosine + 0.5F) * (kCosineBins - 1);
    std::int32_t bin = static_cast<std::int32_t>(cosine_at);
    bin = bin > kCosineBins - 2 ? kCosineBins - 2 : bin;
    cosine_bin[k] = bin;
    cosine_part[k] = cosine_at - static_cast<float>(bin);
    // What is turned away from the keypoint is not seen together with it: the far side of a limb, which a
    // model knows and a picture does not.
    weight[k] = clamp01(cosine);
  }
  PLIANT_INDEPENDENT_ROUNDS
  for (std::size_t k = 0; k < count; ++k) {
    const float lx = xx * px[k] + xy * py[k] + xz * pz[k];
    const float ly = yx * px[k] + yy * py[k] + yz * pz[k];
    // Sector centres stand at half-sectors.
    const float centred = azimuth_of(lx, ly) - 0.5F;
    const float turned = centred + kAzimuths;
    const float at = centred < 0 ? turned : centred;
    std::int32_t bin = static_cast<std::int32_t>(at);
    bin = bin > kAzimuths - 1 ? kAzimuths - 1 : bin;
    azimuth_bin[k] = bin;
    azimuth_part[k] = at - static_cast<float>(bin);
  }
  PLIANT_INDEPENDENT_ROUNDS
  for (std::size_t k = 0; k < count; ++k) {
    // Elevation centres at ±45°: linear in the sine between them. Radial centres at 1/4 and 3/4.
    const float lz = zx * px[k] + zy * py[k] + zz * pz[k];
    const float d = distance[k] > kAtCentre ? distance[k] : kAtCentre;
    up[k] = clamp01(0.5F + 0.70710678F * lz / d);
    outer[k] = clamp01(2 * distance[k] - 0.5F);
    weight[k] = distance[k] < kAtCentre ? 0.0F : weight[k];
  }
}

bool ShotBins::fill(const ShotPoints& points, Descriptor& descriptor) noexcept {
  place(points);
  // [azimuth][cosine][elevation · 2 + radius]: the shells of a bin side by side, added to at once.
  Shells bins[kAzimuths * kCosineBins] = {};
  for (std::size_t k = 0; k < points.count; ++k) {
    const float high = weight_[k] * up_[k], low = weight_[k] - high;
    const float outer = outer_[k], inner = 1 - outer;
    const Shells shells = {low * inner, low * outer, high * inner, high * outer};
    const Shells far = shells * cosine_part_[k], near = shells - far;
    const std::ptrdiff_t azimuth = azimuth_bin_[k], next = (azimuth + 1) & (kAzimuths - 1);
    const Shells far_next = far * azimuth_part_[k], near_next = near * azimuth_part_[k];
    Shells* here = bins + azimuth * kCosineBins + cosine_bin_[k];
    here[0] += near - near_next;
    here[1] += far - far_next;
    Shells* beside = bins + next * kCosineBins + cosine_bin_[k];
    beside[0] += near_next;
    beside[1] += far_next;
  }
  float histogram[kDescriptorSize];
  std::memcpy(histogram, bins, sizeof histogram);
  float lanes[kLanes] = {};
  for (std::size_t i = 0; i < kDescriptorSize; i += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) lanes[l] += histogram[i + l] * histogram[i + l];
  double square = 0;
  for (const float lane : lanes) square += static_cast<double>(lane);
  if (!(square > 0)) return false;
  const auto scale = static_cast<float>(127.0 / std::sqrt(square));
  std::int8_t values[kDescriptorSize];
  for (std::size_t i = 0; i < kDescriptorSize; ++i)
    values[i] = static_cast<std::int8_t>(static_cast<std::int32_t>(histogram[i] * scale + 0.5F));
  // As the descriptor stands in model files: [azimuth][elevation · 2 + radius][cosine].
  std::size_t out = 0;
  for (std::size_t azimuth = 0; azimuth < kAzimuths; ++azimuth)
    for (std::size_t shell = 0; shell < kShells; ++shell)
      for (std::size_t cosine = 0; cosine < kCosineBins; ++cosine)
        descriptor.bins[out++] = values[(azimuth * kCosineBins + cosine) * kShells + shell];
  return true;
}

}  // namespace pliant
