// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/rgb8.h"
#include "planecloud_slam/rosbags/hallway_renderer.h"

namespace planecloud {

/// Figures of an Orbbec Astra as published for it and its kind; lengths on the sensor in pixels of
/// its 640 x 480 depth image, whatever size is rendered.
struct AstraSensorOptions {
  double focal_length = 570.0;    ///< [px]
  double baseline = 0.075;        ///< projector to camera [m]
  double disparity_step = 0.125;  ///< of the quantised disparity [px]
  double disparity_noise = 0.16;  ///< deviation when a surface is near and faces the sensor [px]
  double far_disparity_noise =
      0.24;                      ///< deviation at the end of the range or at grazing angles [px]
  double min_depth = 0.4;        ///< [m]
  double max_depth = 8.0;        ///< [m]
  double grazing_cosine = 0.1;   ///< surfaces seen under a smaller cosine mostly give no answer
  double color_noise = 1.1;      ///< deviation of the luminance at mid grey [grey levels]
  double exposure_drift = 0.07;  ///< amplitude of the slow change of gain, relative
};

/// Which frame of which recording: noise depends on nothing else.
struct SensorFrame {
  std::uint64_t seed = 0;
  std::uint64_t index = 0;
  double time = 0.0;  ///< since the recording's start [s]
};

/// A structured-light depth camera and its colour camera, both seen from the colour camera
/// (registered). Depth: disparity with noise that is correlated over about five pixels, quantised;
/// no answer out of range, in the projector's shadow, at depth edges, at grazing angles and on
/// glass. Colour: gain that drifts, noise of the luminance, weak blocks of chroma noise.
class AstraSensorModel {
 public:
  explicit AstraSensorModel(const AstraSensorOptions& options = {}) : options_(options) {}

  /// Depth in whole millimetres, 0: no answer (the 16UC1 of a depth image).
  [[nodiscard]] Image<std::uint16_t> senseDepth(const RenderedView& view,
                                                const SensorFrame& frame) const;
  [[nodiscard]] Image<Rgb8> senseColor(const RenderedView& view, const SensorFrame& frame) const;
  /// Relative gain of the colour camera at a time, 1 on average.
  [[nodiscard]] double exposure(const SensorFrame& frame) const;

 private:
  [[nodiscard]] Image<float> noisyDisparity(const RenderedView& view,
                                            const SensorFrame& frame) const;
  void dropShadows(const RenderedView& view, Image<float>& disparity) const;
  void dropEdges(const RenderedView& view, const SensorFrame& frame, Image<float>& disparity) const;

  AstraSensorOptions options_;
};

/// The same view through a perfect sensor: exact depth rounded to millimetres, colour rounded.
[[nodiscard]] Image<std::uint16_t> toMillimetres(const Image<float>& depth);
[[nodiscard]] Image<Rgb8> toRgb8(const Image<Eigen::Array3f>& color);

}  // namespace planecloud
