// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include "depth_codec_peers.h"

#ifdef PLANECLOUD_SLAM_HAVE_DRACO
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#endif

namespace planecloud {

#ifdef PLANECLOUD_SLAM_HAVE_DRACO
namespace {

std::vector<Eigen::Vector3f> pointsOf(const Image<float>& depth, const Camera& camera) {
  std::vector<Eigen::Vector3f> points;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const double z = static_cast<double>(depth(x, y));
      if (z > 0.0) points.push_back(camera.backProject(x, y, z).cast<float>());
    }
  }
  return points;
}

std::size_t codedSize(const std::vector<Eigen::Vector3f>& points, int bits) {
  draco::PointCloudBuilder builder;
  builder.Start(static_cast<draco::PointIndex::ValueType>(points.size()));
  const int attribute =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::size_t i = 0; i < points.size(); ++i) {
    builder.SetAttributeValueForPoint(
        attribute, draco::PointIndex(static_cast<draco::PointIndex::ValueType>(i)),
        points[i].data());
  }
  const auto cloud = builder.Finalize(false);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  encoder.SetSpeedOptions(0, 0);
  draco::EncoderBuffer buffer;
  return encoder.EncodePointCloudToBuffer(*cloud, &buffer).ok() ? buffer.size() : 0;
}

/// Draco rounds to 2^bits - 1 steps of the longest side of the bounding box.
double roundingError(const std::vector<Eigen::Vector3f>& points, int bits) {
  Eigen::Vector3f low = points.front();
  Eigen::Vector3f high = low;
  for (const Eigen::Vector3f& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double step = static_cast<double>((high - low).maxCoeff()) / (std::pow(2.0, bits) - 1.0);
  double sum = 0.0;
  for (const Eigen::Vector3f& point : points) {
    const double z = static_cast<double>(point.z() - low.z());
    sum += std::abs(std::round(z / step) * step - z);
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace

CodedDepth encodeDraco(const Image<float>& depth, const Camera& camera, double depth_error) {
  const std::vector<Eigen::Vector3f> points = pointsOf(depth, camera);
  if (points.empty()) return {};
  int bits = 1;
  while (bits < 20 && std::abs(std::log(roundingError(points, bits + 1) / depth_error)) <
                          std::abs(std::log(roundingError(points, bits) / depth_error))) {
    ++bits;
  }
  return {codedSize(points, bits), roundingError(points, bits)};
}
#else
CodedDepth encodeDraco(const Image<float>& /*depth*/, const Camera& /*camera*/,
                       double /*depth_error*/) {
  return {};
}
#endif

}  // namespace planecloud
