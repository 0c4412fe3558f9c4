// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"

/// Other plane extractors, timed beside ours by bench_plane_fit.
namespace planecloud {

/// One image; `planes` of 0: the library is not there.
struct ExtractedPlanes {
  double milliseconds = 0.0;
  std::size_t planes = 0;
};

/// The paper's Algorithm 1 in plain C++: 24 px tiles down to 3 px, corner check, the smallest
/// eigenvector of the 4x4 scatter matrix, mean point-to-plane distance within `tolerance` [m].
[[nodiscard]] ExtractedPlanes extractAsInThePaper(const Image<float>& depth, const Camera& camera,
                                                  double tolerance);
/// How far it has come after a time.
struct FitProgress {
  double milliseconds = 0.0;
  double covered = 0.0;  ///< pixels with depth on accepted tiles
  std::size_t planes = 0;
};
/// The same from 24 px down to `min_tile`, watched: what is there after each accepted tile.
[[nodiscard]] std::vector<FitProgress> watchThePaper(const Image<float>& depth,
                                                     const Camera& camera, double tolerance,
                                                     int min_tile);
/// OpenCV contrib `cv::rgbd::RgbdPlane`, blocks of 20 px.
[[nodiscard]] ExtractedPlanes extractByRgbdPlane(const Image<float>& depth, const Camera& camera);
/// PCL organized multi-plane segmentation with integral-image normals.
[[nodiscard]] ExtractedPlanes extractByPcl(const Image<float>& depth, const Camera& camera);

}  // namespace planecloud
