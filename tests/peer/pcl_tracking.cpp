#include "tests/peer/pcl_tracking.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <pcl/common/transforms.h>
#include <pcl/features/integral_image_normal.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_estimation_organized_projection.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>

namespace peer {

namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

/// As far as Pliant looks for a moved point, and as far apart as normals may lie: both as Pliant has them.
constexpr double kReach = 0.024;
constexpr float kLeastCosine = 0.5F;
constexpr int kRounds = 10;

}  // namespace

struct PclTracker::Parts {
  Cloud::Ptr model{new Cloud};
  int step = 1;
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();
};

PclTracker::PclTracker(const Points& model, const Points& normals, int step) : parts_(new Parts) {
  parts_->step = step;
  for (std::size_t i = 0; i < model.size(); ++i) {
    pcl::PointNormal p;
    p.x = model[i][0];
    p.y = model[i][1];
    p.z = model[i][2];
    p.normal_x = normals[i][0];
    p.normal_y = normals[i][1];
    p.normal_z = normals[i][2];
    parts_->model->push_back(p);
  }
}

PclTracker::~PclTracker() {
  delete parts_;
}

void PclTracker::start_from(const std::array<double, 16>& pose) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      parts_->pose(row, column) = static_cast<float>(pose[static_cast<std::size_t>(4 * row + column)]);
}

std::array<double, 16> PclTracker::process(const Picture& picture) {
  const int step = parts_->step, width = picture.width / step, height = picture.height / step;
  const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  pcl::PointCloud<pcl::PointXYZ>::Ptr scene(new pcl::PointCloud<pcl::PointXYZ>);
  scene->resize(size);
  scene->width = static_cast<std::uint32_t>(width);
  scene->height = static_cast<std::uint32_t>(height);
  scene->is_dense = false;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::uint16_t raw = picture.depth[v * step * picture.stride + u * step];
      const auto z =
          raw == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(raw / picture.depth_scale);
      (*scene)(u, v) = {static_cast<float>((u * step - picture.cx) / picture.fx) * z,
                        static_cast<float>((v * step - picture.cy) / picture.fy) * z, z};
    }
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.COVARIANCE_MATRIX);
  estimation.setMaxDepthChangeFactor(0.02F);
  estimation.setNormalSmoothingSize(5.0F);
  estimation.setInputCloud(scene);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  Cloud::Ptr target(new Cloud);
  pcl::concatenateFields(*scene, normals, *target);

  pcl::registration::CorrespondenceEstimationOrganizedProjection<pcl::PointNormal, pcl::PointNormal>
      projection;
  projection.setFocalLengths(static_cast<float>(picture.fx / step), static_cast<float>(picture.fy / step));
  projection.setCameraCenters(static_cast<float>(picture.cx / step), static_cast<float>(picture.cy / step));
  projection.setDepthThreshold(static_cast<float>(kReach));
  projection.setInputTarget(target);
  const pcl::registration::TransformationEstimationPointToPlaneLLS<pcl::PointNormal, pcl::PointNormal> solver;
  for (int round = 0; round < kRounds; ++round) {
    Cloud::Ptr moved(new Cloud), facing(new Cloud);
    pcl::transformPointCloudWithNormals(*parts_->model, *moved, parts_->pose);
    for (const pcl::PointNormal& p : *moved)
      if (p.getVector3fMap().dot(p.getNormalVector3fMap()) < 0) facing->push_back(p);
    projection.setInputSource(facing);
    pcl::Correspondences all, kept;
    projection.determineCorrespondences(all, kReach);
    for (const pcl::Correspondence& c : all) {
      const auto a = (*facing)[static_cast<std::size_t>(c.index_query)].getNormalVector3fMap();
      const auto b = (*target)[static_cast<std::size_t>(c.index_match)].getNormalVector3fMap();
      if (b.allFinite() && a.dot(b) > kLeastCosine) kept.push_back(c);
    }
    if (kept.size() < 24) break;
    Eigen::Matrix4f change = Eigen::Matrix4f::Identity();
    solver.estimateRigidTransformation(*facing, *target, kept, change);
    parts_->pose = change * parts_->pose;
  }
  std::array<double, 16> out{};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      out[static_cast<std::size_t>(4 * row + column)] = static_cast<double>(parts_->pose(row, column));
  return out;
}

}  // namespace peer
