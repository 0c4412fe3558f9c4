// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "planecloud_slam/plane_fit/camera.h"

/// Other codecs for depth images, measured beside ours by bench_plane_cloud_codec.
namespace planecloud {

/// One coded image; `bytes` of 0: the library is not there or cannot do it.
struct CodedDepth {
  std::size_t bytes = 0;
  double depth_error = 0.0;  ///< mean over the pixels with depth [m]
};

/// JPEG 2000 (OpenCV) of 16-bit inverse depth, holes filled along rows, at the highest compression
/// whose mean error is at most `depth_error` [m].
[[nodiscard]] CodedDepth encodeJpeg2000(const Image<float>& depth, double depth_error);
/// Lossless PNG of 16-bit depth in 0.2 mm.
[[nodiscard]] CodedDepth encodePng(const Image<float>& depth);
/// Draco's k-d tree on the points at the quantisation whose error comes nearest to `depth_error`.
/// It sends no order: a point's error is how far rounding moves it along the axis.
[[nodiscard]] CodedDepth encodeDraco(const Image<float>& depth, const Camera& camera,
                                     double depth_error);

}  // namespace planecloud
