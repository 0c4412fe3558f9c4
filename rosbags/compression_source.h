// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "planecloud_slam/frontend_node/frontend_options.h"
#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// What of a recording is compressed.
struct CompressionSelection {
  bool keyframes = false;      ///< what tracking would send, depth fused, instead of every image
  bool color = false;          ///< frames bring colour for the texture
  std::size_t every = 1;       ///< take each `every`-th image
  std::size_t max_images = 0;  ///< take at most so many, 0: all
};

/// One image to compress.
struct CompressionItem {
  RgbdFrame frame;                         ///< its depth is what is compressed
  std::optional<Image<float>> raw_depth;   ///< of the sensor [m], where `frame` has another one
  std::optional<Image<float>> true_depth;  ///< exact [m], NaN: none
  cv::Mat color;                           ///< 8UC3, blue first; may be empty
};

/// The images of a recording that are to be compressed, one after the other.
class CompressionSource {
 public:
  virtual ~CompressionSource() = default;
  /// Of the items.
  [[nodiscard]] virtual CameraIntrinsics camera() const = 0;
  /// The next item, or nothing at the end. Throws like `Recording::next`.
  [[nodiscard]] virtual std::optional<CompressionItem> next() = 0;
  /// Images of the recording read so far, for a progress bar.
  [[nodiscard]] virtual std::size_t imagesRead() const = 0;
};

/// `options`: of the frontend that makes keyframes. Throws std::invalid_argument for options or a
/// camera that fail their check.
[[nodiscard]] std::unique_ptr<CompressionSource> makeCompressionSource(
    std::shared_ptr<Recording> recording, const CompressionSelection& selection,
    const FrontendOptions& options);

}  // namespace planecloud
