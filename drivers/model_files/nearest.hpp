// Nearest neighbours of points in space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <span>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// A kd-tree over points that must outlive it.
class NearestPoints {
 public:
  explicit NearestPoints(std::span<const Vector3> points) : cloud_{points}, tree_(3, cloud_) {}

  /// The `wanted.size()` nearest to `p`, nearest first, of equals the lower index first, with squared
  /// distances. Returns how many there are.
  std::size_t nearest(const Vector3& p, std::span<std::uint32_t> wanted, std::span<double> squares) const {
    Closest result(wanted, squares);
    tree_.findNeighbors(result, p.data(), nanoflann::SearchParams());
    return result.size();
  }
  /// Index of the nearest to `p`; there must be a point.
  std::uint32_t nearest(const Vector3& p, double& square) const {
    std::uint32_t index = 0;
    nearest(p, {&index, 1}, {&square, 1});
    return index;
  }

 private:
  struct Cloud {
    std::span<const Vector3> points;
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return points[i](static_cast<Eigen::Index>(axis));
    }
    template <typename Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
      return false;
    }
  };

  /// A result set in nanoflann's sense that orders equals by index.
  class Closest {
   public:
    using DistanceType = double;
    Closest(std::span<std::uint32_t> indices, std::span<double> squares)
        : indices_(indices), squares_(squares) {}
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool full() const { return count_ == indices_.size(); }
    bool addPoint(double square, std::uint32_t index) {
      std::size_t place = count_;
      while (place > 0 && (squares_[place - 1] > square ||
                           (squares_[place - 1] == square && indices_[place - 1] > index))) {
        if (place < indices_.size()) {
          indices_[place] = indices_[place - 1];
          squares_[place] = squares_[place - 1];
        }
        --place;
      }
      if (place < indices_.size()) {
        indices_[place] = index;
        squares_[place] = square;
        if (count_ < indices_.size()) ++count_;
      }
      return true;
    }
    /// Just above the worst kept, so that equals of it are still looked at.
    [[nodiscard]] double worstDist() const {
      return full() ? squares_[count_ - 1] * (1 + 1e-12) + 1e-300 : std::numeric_limits<double>::max();
    }

   private:
    std::span<std::uint32_t> indices_;
    std::span<double> squares_;
    std::size_t count_ = 0;
  };

  Cloud cloud_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud, double, std::uint32_t>,
                                      Cloud, 3, std::uint32_t>
      tree_;
};

}  // namespace pliant
