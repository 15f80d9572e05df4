#include "core/registration/scene_features.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/symmetric_eigen.hpp"

namespace pliant {

namespace {

constexpr double kThinning = 0.4;  // of the model's spacing: random samples of a surface come that close
constexpr double kWorkingLeaf =
    1.0 / 7;  // of the support: some 150 points of a plane stand in it, more of what is bent
constexpr double kLeastLean = 0.01;

/// Mean distance of a point to its nearest other, from up to 512 points.
double mean_spacing(const RegistrationState& s, double start) noexcept {
  const std::size_t step = std::max<std::size_t>(1, s.base_count / 512);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < s.base_count; i += step) {
    for (double reach = start; reach < 9 * start; reach *= 2) {
      float square = 0;
      const std::uint32_t j = s.base_grid.nearest_if(s.base[i], static_cast<float>(reach), square,
                                                     [&](std::uint32_t k) { return k != i; });
      if (j == PointGrid::kNone) continue;
      sum += static_cast<double>(std::sqrt(square));
      ++count;
      break;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : start;
}

}  // namespace

void describe_model(RegistrationState& s) noexcept {
  s.model_key_count = std::min<std::size_t>(s.settings.model_keypoints, s.model.size());
  if (s.model_key_count <= s.model.keypoint_count()) {
    s.model_descriptors = s.model.descriptors().first(s.model_key_count);
    s.model_frames = s.model.frames().first(s.model_key_count);
    s.matcher.prepare(s.model_descriptors);
    return;
  }
  if (!s.model_grid.build(s.model.positions(), grid_cell_for_support(s.support))) return;
  const OrientedPoints cloud = {s.model.positions(), s.model.normals()};
  for (std::size_t i = 0; i < s.model_key_count; ++i)
    static_cast<void>(
        s.describers[0].describe(cloud, s.model_grid, i, s.support, s.own_descriptors[i], s.own_frames[i]));
  s.model_descriptors = s.own_descriptors.first(s.model_key_count);
  s.model_frames = s.own_frames.first(s.model_key_count);
  s.matcher.prepare(s.model_descriptors);
}

void thin_scene(RegistrationState& s, std::span<const Point3f> scene) noexcept {
  s.base_count =
      std::min(s.sampling.sample(scene, kThinning * s.model.spacing(), s.base_index), s.base.size());
  for (std::size_t i = 0; i < s.base_count; ++i) s.base[i] = scene[s.base_index[i]];
  static_cast<void>(s.base_grid.build(s.base.first(s.base_count), 2 * s.model.spacing()));
  s.base_spacing = mean_spacing(s, 2 * s.model.spacing());
  s.spacing = std::max(s.model.spacing(), s.base_spacing);
  s.work += scene.size() * work::kThinned;
}

bool scene_is_flat(const RegistrationState& s) noexcept {
  Vector3 mean = Vector3::Zero();
  for (std::size_t i = 0; i < s.base_count; ++i) mean += to_vector(s.base[i]);
  mean /= static_cast<double>(std::max<std::size_t>(1, s.base_count));
  Matrix3 m = Matrix3::Zero();
  for (std::size_t i = 0; i < s.base_count; ++i) {
    const Vector3 d = to_vector(s.base[i]) - mean;
    m += d * d.transpose();
  }
  const SymmetricEigen eigen =
      symmetric_eigen(m / static_cast<double>(std::max<std::size_t>(1, s.base_count)));
  const double off = eigen.values(0) > 0 ? std::sqrt(eigen.values(0)) : 0;
  return s.base_count < ShotDescriber::kLeastNeighbours || off < 0.1 * s.model.spacing();
}

void find_normals(RegistrationState& s) noexcept {
  const double leaf = std::max(kWorkingLeaf * s.support, s.spacing);
  s.working_count = std::min(s.sampling.sample(s.base.first(s.base_count), leaf, s.kept), s.working.size());
  for (std::size_t i = 0; i < s.working_count; ++i) s.working[i] = s.base[s.kept[i]];
  s.work += s.working_count * work::kNormal;
  const std::span<const Point3f> points = s.working.first(s.working_count);
  const std::span<Normal16> normals = s.working_normals.first(s.working_count);
  // Four spacings hold some forty points, enough to average the noise of a whole spacing out.
  estimate_normals(s.base_grid, points, std::max(0.15 * s.support, 4 * s.spacing), normals);
  static_cast<void>(s.working_grid.build(points, grid_cell_for_support(s.support)));
  if (s.one_view || !s.settings.consistent_normals) {
    const Vector3& v = s.eye;
    NormalOrientation::towards(points, to_point(v), normals);
  } else {
    s.orientation.outward(points, s.working_grid, 2.5 * leaf, normals);
  }
}

void sample_keypoints(RegistrationState& s, std::uint32_t wanted) noexcept {
  // Points grow with the square of 1/leaf; a few steps reach the wanted number within some per cent.
  const std::span<const Point3f> points = s.base.first(s.base_count);
  const std::size_t target = std::min<std::size_t>({wanted, s.keys.size(), s.base_count});
  double leaf = s.spacing * std::sqrt(static_cast<double>(s.base_count) /
                                      static_cast<double>(std::max<std::size_t>(1, target)));
  std::size_t count = 0;
  for (int step = 0; step < 6; ++step) {
    count = s.sampling.sample(points, leaf, s.kept);
    const double ratio = static_cast<double>(count) / static_cast<double>(target);
    if (ratio > 0.97 && ratio < 1.03) break;
    if (count == s.base_count && ratio < 1) break;
    leaf *= std::sqrt(ratio);
  }
  s.key_count = std::min(count, s.keys.size());
  for (std::size_t k = 0; k < s.key_count; ++k) s.keys[k] = s.base[s.kept[k]];
}

namespace {

/// Part `piece` of `count` things shared among the workers, rounded to groups of `group`.
struct Share {
  std::size_t first, last;
};
Share share_of(std::size_t piece, std::size_t workers, std::size_t count, std::size_t group) noexcept {
  const std::size_t each = ((count + workers - 1) / workers + group - 1) / group * group;
  const std::size_t first = std::min(piece * each, count);
  return {first, std::min(first + each, count)};
}

}  // namespace

void describe_keypoints(RegistrationState& s) noexcept {
  const OrientedPoints cloud = {s.working.first(s.working_count), s.working_normals.first(s.working_count)};
  const std::size_t workers = s.settings.workers;
  s.settings.sharer.share(workers, [&](std::size_t worker) {
    const Share share = share_of(worker, workers, s.key_count, 1);
    for (std::size_t k = share.first; k < share.last; ++k)
      if (!s.describers[worker].describe_at(cloud, s.working_grid, s.keys[k], s.support, s.key_descriptors[k],
                                            s.key_frames[k], &s.key_leans[k]))
        s.key_leans[k] = 0;
  });
  s.work += s.key_count * work::kDescriptor;
  std::size_t count = 0;
  for (std::size_t k = 0; k < s.key_count; ++k) {
    if (static_cast<double>(s.key_leans[k]) < kLeastLean) continue;
    s.keys[count] = s.keys[k];
    s.key_descriptors[count] = s.key_descriptors[k];
    s.key_frames[count++] = s.key_frames[k];
  }
  s.posed_count = count;
}

void match_keypoints(RegistrationState& s) noexcept {
  const std::size_t workers = s.settings.workers;
  s.work += s.posed_count * s.model_key_count * work::kComparison;
  for (std::size_t worker = 1; worker < workers; ++worker) s.helpers[worker].join(s.matcher);
  s.settings.sharer.share(workers, [&](std::size_t worker) {
    const Share share = share_of(worker, workers, s.posed_count, kBoundQueries);
    DescriptorMatcher& matcher = worker == 0 ? s.matcher : s.helpers[worker];
    matcher.match(s.key_descriptors.subspan(share.first, share.last - share.first), 1,
                  s.matches.subspan(share.first));
  });
  for (std::size_t k = 0; k < s.posed_count; ++k) {
    Match& m = s.matches[k];
    m.scene = static_cast<std::uint16_t>(k);
    s.posed[k] = {s.model.positions()[m.model], s.keys[k], s.model_frames[m.model], s.key_frames[k], m.dot};
  }
}

}  // namespace pliant
