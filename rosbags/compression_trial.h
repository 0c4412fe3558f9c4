// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "planecloud_slam/frontend_node/keyframe_payload.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/rosbags/compression_source.h"

namespace planecloud {

/// How frames are compressed.
struct CompressionOptions {
  QuadtreeFitterOptions plane_fit;
  CodecOptions codec;  ///< its byte budget counts texture too
  TextureOptions texture;
};

/// Mean distances [m] along the viewing ray to the true surface, over the pixels where sensor,
/// planes and truth all have depth.
struct TrueErrors {
  double compressed = 0.0;  ///< of the planes
  double raw = 0.0;         ///< of the sensor
};

/// One frame, compressed and restored.
struct CompressedFrame {
  std::string robot;
  double stamp = 0.0;               ///< [s]
  double fit_time = 0.0;            ///< [s]
  double encode_time = 0.0;         ///< [s]
  double decode_time = 0.0;         ///< [s]
  std::size_t bytes = 0;            ///< of the coded planes and the texture
  std::size_t texture_bytes = 0;    ///< of the texture
  std::size_t lossless_bytes = 0;   ///< of the depth itself (LOSSLESS)
  std::size_t planes = 0;           ///< restored
  double coverage = 0.0;            ///< share of the sensor's depths that have a plane
  double point_plane_error = 0.0;   ///< mean distance of the covered points to their planes [m]
  double depth_error = 0.0;         ///< mean difference of their depth [m]
  std::optional<TrueErrors> truth;  ///< only of the built-in world
  PlaneCloud cloud;                 ///< restored
  Image<float> depth;               ///< of the restored planes [m], NaN: none
  KeyframeTexture texture;
};

/// Fits, encodes and decodes depth images of one camera, lens distortion and all, and measures what
/// became of them.
class CompressionTrial {
 public:
  /// Throws std::invalid_argument when options or camera fail their check.
  CompressionTrial(const CameraIntrinsics& camera, const CompressionOptions& options);

  [[nodiscard]] CompressedFrame compress(const CompressionItem& item);

 private:
  std::shared_ptr<const Camera> camera_;
  CompressionOptions options_;
  QuadtreeFitter fitter_;
};

}  // namespace planecloud
