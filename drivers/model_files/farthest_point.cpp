#include "drivers/model_files/farthest_point.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace pliant {

namespace {

constexpr std::size_t kBucketSize = 64;
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Points that lie together. A new sample only touches those buckets that it can come nearer to.
struct Bucket {
  std::uint32_t begin = 0, end = 0;  // in `members`
  Vector3 lowest = Vector3::Zero(), highest = Vector3::Zero();
  double farthest = kFar;  // the largest squared distance of a member to the samples
  std::uint32_t farthest_index = 0;
};

class Buckets {
 public:
  explicit Buckets(std::span<const Vector3> points)
      : points_(points), members_(points.size()), squares_(points.size(), kFar) {
    std::iota(members_.begin(), members_.end(), 0U);
    split(0, static_cast<std::uint32_t>(points.size()));
  }

  /// Takes sample `s` into account; its own distance becomes -1, so that it is never taken again.
  void add_sample(std::uint32_t s) {
    const Vector3& p = points_[s];
    for (Bucket& bucket : buckets_) {
      const Vector3 outside = (bucket.lowest - p).cwiseMax(p - bucket.highest).cwiseMax(Vector3::Zero());
      if (outside.squaredNorm() > bucket.farthest) continue;
      bucket.farthest = -1;
      for (std::uint32_t m = bucket.begin; m < bucket.end; ++m) {
        const std::uint32_t i = members_[m];
        squares_[i] = i == s ? -1 : std::min(squares_[i], (points_[i] - p).squaredNorm());
        if (squares_[i] > bucket.farthest || (squares_[i] == bucket.farthest && i < bucket.farthest_index)) {
          bucket.farthest = squares_[i];
          bucket.farthest_index = i;
        }
      }
    }
  }

  /// The point farthest from all samples, and its squared distance.
  [[nodiscard]] std::uint32_t farthest(double& square) const {
    const Bucket* best = &buckets_.front();
    for (const Bucket& bucket : buckets_)
      if (bucket.farthest > best->farthest ||
          (bucket.farthest == best->farthest && bucket.farthest_index < best->farthest_index))
        best = &bucket;
    square = best->farthest;
    return best->farthest_index;
  }

 private:
  void split(std::uint32_t begin, std::uint32_t end) {
    Bucket bucket{begin, end, points_[members_[begin]], points_[members_[begin]]};
    for (std::uint32_t m = begin; m < end; ++m) {
      bucket.lowest = bucket.lowest.cwiseMin(points_[members_[m]]);
      bucket.highest = bucket.highest.cwiseMax(points_[members_[m]]);
    }
    if (end - begin <= kBucketSize) {
      buckets_.push_back(bucket);
      return;
    }
    Eigen::Index axis = 0;
    (bucket.highest - bucket.lowest).maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto place = [&](std::uint32_t m) { return members_.begin() + static_cast<std::ptrdiff_t>(m); };
    std::nth_element(place(begin), place(middle), place(end), [&](std::uint32_t a, std::uint32_t b) {
      const double x = points_[a](axis), y = points_[b](axis);
      return x < y || (x == y && a < b);
    });
    split(begin, middle);
    split(middle, end);
  }

  std::span<const Vector3> points_;
  std::vector<std::uint32_t> members_;
  std::vector<double> squares_;
  std::vector<Bucket> buckets_;
};

}  // namespace

std::vector<std::uint32_t> farthest_point_order(std::span<const Vector3> points, std::size_t most,
                                                double least_distance) {
  std::vector<std::uint32_t> order;
  if (points.empty() || most == 0) return order;
  Vector3 lowest = points[0], highest = points[0];
  for (const Vector3& p : points) {
    lowest = lowest.cwiseMin(p);
    highest = highest.cwiseMax(p);
  }
  const Vector3 middle = 0.5 * (lowest + highest);
  std::uint32_t next = 0;
  for (std::uint32_t i = 1; i < points.size(); ++i)
    if ((points[i] - middle).squaredNorm() > (points[next] - middle).squaredNorm()) next = i;

  const std::size_t count = std::min(most, points.size());
  order.reserve(count);
  Buckets buckets(points);
  for (;;) {
    order.push_back(next);
    if (order.size() == count) return order;
    buckets.add_sample(next);
    double square = 0;
    next = buckets.farthest(square);
    if (square < least_distance * least_distance) return order;
  }
}

}  // namespace pliant
