#include "tests/peer/pcl_pipeline.hpp"

#include <ctime>

#include <cmath>

#include <pcl/common/transforms.h>
#include <pcl/features/normal_3d.h>
#include <pcl/features/shot.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <pcl/recognition/cg/geometric_consistency.h>
#include <pcl/registration/icp.h>

namespace peer {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Descriptors = pcl::PointCloud<pcl::SHOT352>;

Cloud::Ptr cloud_of(const Points& points) {
  Cloud::Ptr cloud(new Cloud);
  for (const auto& p : points) cloud->push_back({p[0], p[1], p[2]});
  return cloud;
}

Normals::Ptr normals_of(const Cloud::Ptr& cloud, int neighbours) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setKSearch(neighbours);
  estimation.setInputCloud(cloud);
  Normals::Ptr normals(new Normals);
  estimation.compute(*normals);
  return normals;
}

void orient(Normals& normals, const Points& signs) {
  for (std::size_t i = 0; i < normals.size() && i < signs.size(); ++i) {
    pcl::Normal& n = normals[i];
    if (n.normal_x * signs[i][0] + n.normal_y * signs[i][1] + n.normal_z * signs[i][2] >= 0) continue;
    n.normal_x = -n.normal_x;
    n.normal_y = -n.normal_y;
    n.normal_z = -n.normal_z;
  }
}

Cloud::Ptr sampled(const Cloud::Ptr& cloud, double leaf) {
  pcl::UniformSampling<pcl::PointXYZ> sampling;
  sampling.setInputCloud(cloud);
  sampling.setRadiusSearch(leaf);
  Cloud::Ptr keypoints(new Cloud);
  sampling.filter(*keypoints);
  return keypoints;
}

/// The leaf that gives about so many keypoints.
double leaf_for(const Cloud::Ptr& cloud, std::size_t wanted) {
  double low = 1e-4, high = 1;
  for (int step = 0; step < 40; ++step) {
    const double leaf = std::sqrt(low * high);
    (sampled(cloud, leaf)->size() > wanted ? low : high) = leaf;
  }
  return high;
}

Descriptors::Ptr described(const Cloud::Ptr& keypoints, const Cloud::Ptr& cloud, const Normals::Ptr& normals,
                           double support) {
  pcl::SHOTEstimation<pcl::PointXYZ, pcl::Normal, pcl::SHOT352> shot;
  shot.setRadiusSearch(support);
  shot.setInputCloud(keypoints);
  shot.setInputNormals(normals);
  shot.setSearchSurface(cloud);
  Descriptors::Ptr descriptors(new Descriptors);
  shot.compute(*descriptors);
  return descriptors;
}

std::array<double, 16> rows_of(const Eigen::Matrix4f& m) {
  std::array<double, 16> rows{};
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) rows[static_cast<std::size_t>(4 * r + c)] = static_cast<double>(m(r, c));
  return rows;
}

}  // namespace

double process_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

struct PclPipeline::Parts {
  PclSettings settings;
  Cloud::Ptr model, keypoints;
  Descriptors::Ptr descriptors;
  mutable double scene_leaf = 0;
};

PclPipeline::PclPipeline(const Points& model, const Points& model_signs, const PclSettings& settings)
    : parts_(new Parts) {
  parts_->settings = settings;
  parts_->model = cloud_of(model);
  const Normals::Ptr normals = normals_of(parts_->model, settings.normal_neighbours);
  orient(*normals, model_signs);
  parts_->keypoints = sampled(parts_->model, leaf_for(parts_->model, settings.model_keypoints));
  parts_->descriptors = described(parts_->keypoints, parts_->model, normals, settings.support);
}

PclPipeline::~PclPipeline() {
  delete parts_;
}

PclResult PclPipeline::run(const Points& scene, const Points& scene_signs, bool refine) const {
  const PclSettings& settings = parts_->settings;
  PclResult result;
  const Cloud::Ptr cloud = cloud_of(scene);
  if (parts_->scene_leaf == 0) parts_->scene_leaf = leaf_for(cloud, settings.scene_keypoints);

  double last = process_ms();
  const auto lap = [&last] {
    const double now = process_ms(), took = now - last;
    last = now;
    return took;
  };
  const Normals::Ptr normals = normals_of(cloud, settings.normal_neighbours);
  result.times.normals = lap();
  orient(*normals, scene_signs);
  lap();
  const Cloud::Ptr keypoints = sampled(cloud, parts_->scene_leaf);
  result.times.keypoints = lap();
  const Descriptors::Ptr descriptors = described(keypoints, cloud, normals, settings.support);
  result.times.descriptors = lap();

  pcl::CorrespondencesPtr pairs(new pcl::Correspondences);
  pcl::KdTreeFLANN<pcl::SHOT352> tree;
  tree.setInputCloud(parts_->descriptors);
  std::vector<int> index(1);
  std::vector<float> distance(1);
  for (std::size_t k = 0; k < descriptors->size(); ++k) {
    if (!std::isfinite(descriptors->at(k).descriptor[0])) continue;
    if (tree.nearestKSearch(descriptors->at(k), 1, index, distance) == 1 && distance[0] < 0.25F)
      pairs->push_back(pcl::Correspondence(index[0], static_cast<int>(k), distance[0]));
  }
  result.times.matching = lap();

  pcl::GeometricConsistencyGrouping<pcl::PointXYZ, pcl::PointXYZ> grouping;
  grouping.setGCSize(settings.consistency);
  grouping.setGCThreshold(settings.least_members);
  grouping.setInputCloud(parts_->keypoints);
  grouping.setSceneCloud(keypoints);
  grouping.setModelSceneCorrespondences(pairs);
  std::vector<Eigen::Matrix4f, Eigen::aligned_allocator<Eigen::Matrix4f>> poses;
  std::vector<pcl::Correspondences> groups;
  grouping.recognize(poses, groups);
  result.times.grouping = lap();

  result.model_keypoints = parts_->keypoints->size();
  result.scene_keypoints = keypoints->size();
  result.correspondences = pairs->size();
  std::size_t best = 0;
  for (std::size_t k = 1; k < groups.size(); ++k)
    if (groups[k].size() > groups[best].size()) best = k;
  result.found = !poses.empty();
  if (!result.found) return result;
  result.grouped = rows_of(poses[best]);
  if (!refine) return result;
  Cloud::Ptr placed(new Cloud), aligned(new Cloud);
  pcl::transformPointCloud(*parts_->model, *placed, poses[best]);
  lap();
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputSource(placed);
  icp.setInputTarget(cloud);
  icp.setMaxCorrespondenceDistance(settings.consistency);
  icp.setMaximumIterations(50);
  icp.align(*aligned);
  result.icp = lap();
  result.refined = rows_of(icp.getFinalTransformation() * poses[best]);
  return result;
}

}  // namespace peer
