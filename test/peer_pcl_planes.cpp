// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <limits>

#include "plane_fit_peers.h"

#ifdef PLANECLOUD_SLAM_HAVE_PCL
#include <pcl/features/integral_image_normal.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/organized_multi_plane_segmentation.h>
#endif

namespace planecloud {

#ifdef PLANECLOUD_SLAM_HAVE_PCL
ExtractedPlanes extractByPcl(const Image<float>& depth, const Camera& camera) {
  using Points = pcl::PointCloud<pcl::PointXYZ>;
  using Normals = pcl::PointCloud<pcl::Normal>;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto points = pcl::make_shared<Points>(static_cast<std::uint32_t>(depth.width()),
                                               static_cast<std::uint32_t>(depth.height()));
  points->is_dense = false;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const Eigen::Vector3f point =
          camera.backProject(x, y, static_cast<double>(depth(x, y))).cast<float>();
      points->at(x, y).getVector3fMap() =
          depth(x, y) > 0.0F ? point : Eigen::Vector3f(nan, nan, nan);
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const auto normals = pcl::make_shared<Normals>();
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.COVARIANCE_MATRIX);
  estimation.setMaxDepthChangeFactor(0.02F);
  estimation.setNormalSmoothingSize(10.0F);
  estimation.setInputCloud(points);
  estimation.compute(*normals);
  pcl::OrganizedMultiPlaneSegmentation<pcl::PointXYZ, pcl::Normal, pcl::Label> segmentation;
  segmentation.setMinInliers(1000);
  segmentation.setAngularThreshold(3.0 * 3.14159265358979323846 / 180.0);
  segmentation.setDistanceThreshold(0.02);
  segmentation.setInputCloud(points);
  segmentation.setInputNormals(normals);
  std::vector<pcl::PlanarRegion<pcl::PointXYZ>,
              Eigen::aligned_allocator<pcl::PlanarRegion<pcl::PointXYZ>>>
      regions;
  segmentation.segmentAndRefine(regions);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  return {time.count(), regions.size()};
}
#else
ExtractedPlanes extractByPcl(const Image<float>& /*depth*/, const Camera& /*camera*/) { return {}; }
#endif

}  // namespace planecloud
