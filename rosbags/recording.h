// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/camera.h"

namespace planecloud {

/// A pose at a time.
struct StampedPose {
  double stamp = 0.0;  ///< [s]
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/// A trajectory ordered by stamp. For ground truth: optical frame in the world.
using Trajectory = std::vector<StampedPose>;

/// One robot's camera, frame by frame, wherever it comes from (bag, TUM folder, built-in world).
class Recording {
 public:
  virtual ~Recording() = default;

  /// Name of the robot, "robot" + number or the bag's namespace; unique within one input.
  [[nodiscard]] virtual const std::string& robot() const = 0;
  [[nodiscard]] virtual const CameraIntrinsics& camera() const = 0;
  /// Number of frames where it is known beforehand (progress), else 0.
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// The next pair, or nothing at the end. Throws std::runtime_error naming file, cause and cure.
  [[nodiscard]] virtual std::optional<RgbdFrame> next() = 0;
  /// Empty when there is none.
  [[nodiscard]] virtual const Trajectory& groundTruth() const = 0;
  /// Exact depth of the frame last returned [m], NaN: none; only the built-in world knows it.
  [[nodiscard]] virtual std::optional<Image<float>> trueDepth() const { return std::nullopt; }
  /// Where the first frame was taken in the odometry frame, at least its height and tilt; none: a
  /// level camera is assumed.
  [[nodiscard]] virtual std::optional<Eigen::Isometry3d> startPose() const { return std::nullopt; }
  /// Colour of the frame last returned, 8UC3, blue first; empty when only grey is known.
  [[nodiscard]] virtual cv::Mat color() const { return {}; }
};

}  // namespace planecloud
