// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// What the command line says of a sequence; goes before its camera.yaml.
struct SequenceOptions {
  std::optional<CameraIntrinsics> camera;  ///< width and height 0: those of the images
  std::optional<double> depth_scale;       ///< depth pixels per metre, > 0
};

/// One line of associations.txt.
struct SequencePair {
  double color_stamp = 0.0;  ///< [s]
  std::string color_path;
  double depth_stamp = 0.0;  ///< [s]
  std::string depth_path;
};

/// A folder in the layout of the TUM RGB-D benchmark: associations.txt (`stamp rgb/file stamp
/// depth/file`), optional groundtruth.txt, optional camera.yaml (fx fy cx cy, distortion, width,
/// height, depth_scale).
struct SequenceFolder {
  std::string path;
  std::vector<SequencePair> pairs;  ///< in the order of associations.txt
  CameraIntrinsics camera;
  double depth_scale = 5000.0;  ///< depth pixels per metre
  Trajectory ground_truth;      ///< empty when there is none
};

/// Reads everything but the images, and checks that each of them is there. Throws UsageError when
/// the camera is known neither from camera.yaml nor from `options`, std::runtime_error naming file,
/// line and cure for anything else.
[[nodiscard]] SequenceFolder openSequenceFolder(const std::string& path,
                                                const SequenceOptions& options);

/// A pair as it lies in the folder.
struct SequenceImages {
  cv::Mat color;       ///< 8UC3, blue green red
  Image<float> depth;  ///< [m], NaN: none
};

/// Reads one pair. Throws std::runtime_error naming the file when an image cannot be read, has
/// another pixel type or another size than the camera.
[[nodiscard]] SequenceImages readSequenceImages(const SequenceFolder& folder,
                                                const SequencePair& pair);

/// Grey levels as the tracker sees them (ITU-R BT.601) of an 8UC3 image, blue first.
[[nodiscard]] Image<std::uint8_t> greyFromColor(const cv::Mat& color);

}  // namespace planecloud
