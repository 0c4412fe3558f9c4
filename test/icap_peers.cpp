// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "icap_peers.h"

#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_rejection_surface_normal.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>

#include <cmath>

#include "thread_time.h"

namespace planecloud {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

constexpr float kPointToPlaneVoxel = 0.03F;  // [m]
constexpr float kGeneralisedVoxel = 0.04F;   // [m]
constexpr float kFarthestDepth = 6.0F;       // as ICaP [m]
constexpr int kNeighbours = 20;              // of normals and covariances
// Longest matches one after the other [m]: with a single length ICP either takes along what only
// one view sees, or never gets near. On 17 pairs of each set: 31 and 5 % in one stage of 30 cm
// without regard to normals, 58 and 5 % with, 71 and 29 % in these four.
constexpr double kPointToPlaneMatches[] = {0.5, 0.2, 0.1, 0.05};
constexpr int kPointToPlaneIterations = 30;  // a stage
constexpr double kWidestAngle = 0.785;       // between the normals of a match [rad]
constexpr double kGeneralisedMatches[] = {0.3};
constexpr int kGeneralisedIterations = 50;

/// PCL keeps the computation of covariances to itself, which forbids timing it apart.
class Gicp : public pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> {
 public:
  [[nodiscard]] MatricesVectorPtr covariancesOf(const Cloud::Ptr& cloud) {
    const auto tree = std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
    tree->setInputCloud(cloud);
    const auto covariances = std::make_shared<MatricesVector>();
    computeCovariances<pcl::PointXYZ>(cloud, tree, *covariances);
    return covariances;
  }
};

Cloud::Ptr densePoints(const Image<float>& depth, const CameraIntrinsics& camera) {
  const auto cloud = std::make_shared<Cloud>();
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const float z = depth(x, y);
      if (!(z > 0.0F && z < kFarthestDepth)) continue;
      cloud->push_back({static_cast<float>((x - camera.cx) / camera.fx) * z,
                        static_cast<float>((y - camera.cy) / camera.fy) * z, z});
    }
  }
  return cloud;
}

Cloud::Ptr voxels(const Cloud::Ptr& cloud, float side) {
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(side, side, side);
  const auto result = std::make_shared<Cloud>();
  grid.filter(*result);
  return result;
}

NormalCloud::Ptr withNormals(const Cloud::Ptr& cloud) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setKSearch(kNeighbours);
  const auto result = std::make_shared<NormalCloud>();
  estimation.compute(*result);
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    (*result)[i].getVector3fMap() = (*cloud)[i].getVector3fMap();
  }
  return result;
}

/// Aligns by matches of at most these lengths, one after the other.
template <typename Points, typename Registration, typename Lengths>
Eigen::Isometry3d run(Registration& registration, const Lengths& longest_matches,
                      const Eigen::Isometry3d& T_target_source_guess) {
  Eigen::Matrix4f found = T_target_source_guess.matrix().cast<float>();
  for (const double longest : longest_matches) {
    registration.setMaxCorrespondenceDistance(longest);
    Points aligned;
    registration.align(aligned, found);
    found = registration.getFinalTransformation();
  }
  const Eigen::Matrix4d T = found.cast<double>();
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(T.topLeftCorner<3, 3>()).normalized().toRotationMatrix();
  result.translation() = T.topRightCorner<3, 1>();
  return result;
}

}  // namespace

struct DenseView::Clouds {
  NormalCloud::Ptr with_normals;
  Cloud::Ptr points;
  Gicp::MatricesVectorPtr covariances;
  double normals_time = 0.0;
  double covariances_time = 0.0;
};

DenseView::DenseView(const Image<float>& depth, const CameraIntrinsics& camera)
    : clouds_(std::make_unique<Clouds>()) {
  const Cloud::Ptr dense = densePoints(depth, camera);
  const Cloud::Ptr fine = voxels(dense, kPointToPlaneVoxel);
  double start = threadTime();
  clouds_->with_normals = withNormals(fine);
  clouds_->normals_time = threadTime() - start;
  clouds_->points = voxels(dense, kGeneralisedVoxel);
  start = threadTime();
  clouds_->covariances = Gicp().covariancesOf(clouds_->points);
  clouds_->covariances_time = threadTime() - start;
}
DenseView::~DenseView() = default;
DenseView::DenseView(DenseView&&) noexcept = default;
DenseView& DenseView::operator=(DenseView&&) noexcept = default;

double DenseView::normalsTime() const { return clouds_->normals_time; }
double DenseView::covariancesTime() const { return clouds_->covariances_time; }

Eigen::Isometry3d alignPointToPlane(const DenseView& target, const DenseView& source,
                                    const Eigen::Isometry3d& T_target_source_guess) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> registration;
  registration.setInputSource(source.clouds().with_normals);
  registration.setInputTarget(target.clouds().with_normals);
  registration.setTransformationEpsilon(1e-8);
  registration.setMaximumIterations(kPointToPlaneIterations);
  const auto rejector = std::make_shared<pcl::registration::CorrespondenceRejectorSurfaceNormal>();
  rejector->setThreshold(std::cos(kWidestAngle));
  registration.addCorrespondenceRejector(rejector);
  return run<NormalCloud>(registration, kPointToPlaneMatches, T_target_source_guess);
}

Eigen::Isometry3d alignGeneralised(const DenseView& target, const DenseView& source,
                                   const Eigen::Isometry3d& T_target_source_guess) {
  Gicp registration;
  registration.setInputSource(source.clouds().points);
  registration.setInputTarget(target.clouds().points);
  registration.setSourceCovariances(source.clouds().covariances);
  registration.setTargetCovariances(target.clouds().covariances);
  registration.setMaximumIterations(kGeneralisedIterations);
  return run<Cloud>(registration, kGeneralisedMatches, T_target_source_guess);
}

}  // namespace planecloud
