// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <limits>

#include "plane_fit_peers.h"

#ifdef PLANECLOUD_SLAM_HAVE_RGBD
#include <opencv2/rgbd.hpp>
#endif

namespace planecloud {

#ifdef PLANECLOUD_SLAM_HAVE_RGBD
ExtractedPlanes extractByRgbdPlane(const Image<float>& depth, const Camera& camera) {
  cv::Mat3f points(depth.height(), depth.width());
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const Eigen::Vector3f point =
          camera.backProject(x, y, static_cast<double>(depth(x, y))).cast<float>();
      const bool valid = depth(x, y) > 0.0F;
      const float nan = std::numeric_limits<float>::quiet_NaN();
      points(y, x) = valid ? cv::Vec3f(point.x(), point.y(), point.z()) : cv::Vec3f(nan, nan, nan);
    }
  }
  // Without normals it reckons them itself, block by block: its fastest way.
  cv::rgbd::RgbdPlane extractor;
  extractor.setBlockSize(20);
  cv::Mat mask;
  cv::Mat planes;
  const auto start = std::chrono::steady_clock::now();
  extractor(points, mask, planes);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  return {time.count(), planes.total()};
}
#else
ExtractedPlanes extractByRgbdPlane(const Image<float>& /*depth*/, const Camera& /*camera*/) {
  return {};
}
#endif

}  // namespace planecloud
