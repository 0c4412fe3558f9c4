// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/time.h>

#include <algorithm>
#include <cstdint>

#include "planecloud_slam/plane_fit/keyframe_rounding.h"
#include "planecloud_slam/planecloud_msgs/conversions.h"

namespace planecloud {
namespace {

constexpr std::uint32_t kNanoseconds = 1000000000;

constexpr std::uint8_t kStoppedByTime = 1;
constexpr std::uint8_t kStoppedByBytes = 2;

constexpr std::uint64_t kRawPlaneBytes = 32;

CameraIntrinsics readCamera(const planecloud_slam::PlaneCloud& message) {
  CameraIntrinsics camera;
  camera.width = message.width;
  camera.height = message.height;
  camera.fx = message.fx;
  camera.fy = message.fy;
  camera.cx = message.cx;
  camera.cy = message.cy;
  const std::size_t coefficients = message.distortion.size();
  if (coefficients != 0 && coefficients != camera.distortion.size()) {
    refuseMessage("distortion has " + std::to_string(coefficients) +
                  " coefficients: must be 0 or 5");
  }
  std::copy(message.distortion.begin(), message.distortion.end(), camera.distortion.begin());
  try {
    camera.check();
  } catch (const std::invalid_argument& error) {
    refuseMessage(error.what());
  }
  return camera;
}

PlaneCloudEncoding readEncoding(std::uint8_t number) {
  const PlaneCloudEncoding encoding{number};
  switch (encoding) {
    case PlaneCloudEncoding::kRaw:
    case PlaneCloudEncoding::kCompact:
    case PlaneCloudEncoding::kLossless:
      return encoding;
  }
  refuseMessage("encoding " + std::to_string(number) +
                " of the plane cloud is unknown: must be 1 (RAW), 2 (COMPACT) or 3 (LOSSLESS); "
                "update this package");
}

void checkPlaneCount(const EncodedPlaneCloud& planes) {
  const auto pixels = static_cast<std::uint64_t>(planes.camera.width) *
                      static_cast<std::uint64_t>(planes.camera.height);
  const std::uint64_t count = planes.plane_count;
  std::uint64_t most = planes.bytes.empty() ? 0 : pixels;
  if (planes.encoding == PlaneCloudEncoding::kLossless) most = 0;
  if (planes.encoding == PlaneCloudEncoding::kRaw) {
    most = std::min<std::uint64_t>(most, planes.bytes.size() / kRawPlaneBytes);
  }
  if (count <= most) return;
  refuseMessage("plane count " + std::to_string(count) + " is impossible for " +
                std::to_string(planes.bytes.size()) + " bytes and an image of " +
                std::to_string(planes.camera.width) + " x " + std::to_string(planes.camera.height));
}

}  // namespace

planecloud_slam::PlaneCloud toMessage(const EncodedPlaneCloud& planes, double stamp,
                                      const std::string& frame_id) {
  planes.camera.check();
  planecloud_slam::PlaneCloud message;
  message.header.stamp = ros::Time(stamp);
  message.header.frame_id = frame_id;
  message.fx = static_cast<float>(planes.camera.fx);
  message.fy = static_cast<float>(planes.camera.fy);
  message.cx = static_cast<float>(planes.camera.cx);
  message.cy = static_cast<float>(planes.camera.cy);
  if (planes.camera.hasDistortion()) {
    for (const double k : planes.camera.distortion) {
      message.distortion.push_back(static_cast<float>(k));
    }
  }
  message.width = static_cast<std::uint16_t>(planes.camera.width);
  message.height = static_cast<std::uint16_t>(planes.camera.height);
  message.encoding = static_cast<std::uint8_t>(planes.encoding);
  message.plane_count = planes.plane_count;
  message.data = planes.bytes;
  const PackedStatistics packed = packStatistics(planes.statistics);
  message.coverage = packed.coverage;
  message.point_plane_error = packed.point_plane_error;
  message.depth_error = packed.depth_error;
  message.fit_time = packed.fit_time;
  if (planes.statistics.stopped_by_time) message.stopped_by |= kStoppedByTime;
  if (planes.statistics.stopped_by_bytes) message.stopped_by |= kStoppedByBytes;
  return message;
}

EncodedPlaneCloud fromMessage(const planecloud_slam::PlaneCloud& message) {
  if (message.header.stamp.nsec >= kNanoseconds) {
    refuseMessage("stamp has " + std::to_string(message.header.stamp.nsec) +
                  " nanoseconds: must be below 1000000000");
  }
  EncodedPlaneCloud planes;
  planes.camera = readCamera(message);
  planes.encoding = readEncoding(message.encoding);
  planes.plane_count = message.plane_count;
  planes.bytes = message.data;
  checkPlaneCount(planes);
  planes.statistics = unpackStatistics(
      {message.coverage, message.point_plane_error, message.depth_error, message.fit_time});
  planes.statistics.stopped_by_time = (message.stopped_by & kStoppedByTime) != 0;
  planes.statistics.stopped_by_bytes = (message.stopped_by & kStoppedByBytes) != 0;
  return planes;
}

}  // namespace planecloud
