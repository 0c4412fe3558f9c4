// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"

/// Recorded depth images for tests and benchmarks that look at real data where there is some.
namespace planecloud {

/// Depth images [m] of one TUM RGB-D sequence and their camera.
struct RecordedDepth {
  CameraIntrinsics camera;
  std::vector<Image<float>> depth;
};

/// freiburg1 colour camera as published with the benchmark.
inline CameraIntrinsics freiburg1Camera() {
  return {640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
}
/// freiburg3 colour camera, images already undistorted.
inline CameraIntrinsics freiburg3Camera() { return {640, 480, 535.4, 539.2, 320.1, 247.6, {}}; }

/// Folder with the sequences: $PLANECLOUD_SLAM_DATA, else `../shared/data` beside the sources.
inline std::filesystem::path recordedDataFolder() {
  if (const char* folder = std::getenv("PLANECLOUD_SLAM_DATA")) return folder;
  return std::filesystem::path(__FILE__).parent_path() / "../../shared/data";
}

/// Depth images of a sequence in order; none when its folder is missing.
inline std::vector<std::filesystem::path> recordedDepthFiles(const std::string& sequence) {
  const std::filesystem::path folder = recordedDataFolder() / sequence / "depth";
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// One of them [m].
inline Image<float> readRecordedDepth(const std::filesystem::path& file) {
  const cv::Mat raw = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  Image<float> depth(raw.cols, raw.rows);
  std::transform(raw.begin<std::uint16_t>(), raw.end<std::uint16_t>(), depth.begin(),
                 [](std::uint16_t d) { return static_cast<float>(d) / 5000.0F; });
  return depth;
}

/// At most `count` images, evenly spread over the sequence; none when the folder is missing.
inline RecordedDepth loadRecordedDepth(const std::string& sequence, std::size_t count) {
  RecordedDepth recorded;
  recorded.camera =
      sequence.find("fr1") != std::string::npos ? freiburg1Camera() : freiburg3Camera();
  const std::vector<std::filesystem::path> files = recordedDepthFiles(sequence);
  count = std::min(count, files.size());
  for (std::size_t i = 0; i < count; ++i) {
    recorded.depth.push_back(readRecordedDepth(files[i * files.size() / count]));
  }
  return recorded;
}

}  // namespace planecloud
