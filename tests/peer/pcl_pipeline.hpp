// The paper's pipeline from the Point Cloud Library's parts, as in its tutorial on correspondence grouping.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace peer {

using Points = std::vector<std::array<float, 3>>;

struct PclSettings {
  int normal_neighbours = 10;
  double support = 0.035;      ///< of the descriptors, metres
  double consistency = 0.012;  ///< of geometric-consistency grouping, metres
  int least_members = 5;
  std::size_t model_keypoints = 1800, scene_keypoints = 1870;  ///< the sampling's leaf is sought beforehand
};

struct PclTimes {
  double normals = 0, keypoints = 0, descriptors = 0, matching = 0, grouping = 0;  ///< processor time, ms
  [[nodiscard]] double total() const { return normals + keypoints + descriptors + matching + grouping; }
};

struct PclResult {
  std::size_t model_keypoints = 0, scene_keypoints = 0, correspondences = 0;
  bool found = false;
  std::array<double, 16> grouped{};  ///< scene <- model, row-major: the transform of the largest instance
  std::array<double, 16> refined{};  ///< the same after ICP, whose time is apart
  double icp = 0;                    ///< processor time, ms
  PclTimes times;
};

/// Normals are PCL's own; their signs are those of `signs`, one a point, at no cost: outward, the best that
/// PCL could do. What belongs to the model is done in the constructor and not timed.
class PclPipeline {
 public:
  PclPipeline(const Points& model, const Points& model_signs, const PclSettings& settings);
  ~PclPipeline();
  PclPipeline(const PclPipeline&) = delete;
  PclPipeline& operator=(const PclPipeline&) = delete;
  [[nodiscard]] PclResult run(const Points& scene, const Points& scene_signs, bool refine) const;

 private:
  struct Parts;
  Parts* parts_;
};

/// Processor time of this process, ms.
double process_ms();

}  // namespace peer
