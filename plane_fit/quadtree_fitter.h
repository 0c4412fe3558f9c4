// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "planecloud_slam/plane_fit/budget.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"
#include "planecloud_slam/plane_fit/quadtree_fitter_options.h"

namespace planecloud {

/// Turns depth images into plane clouds: the paper's Algorithm 1, fitted by regression in inverse
/// depth on moments that are summed once and merged upwards. One per thread: it keeps its
/// workspace, so that after the first frame only the returned tiles are allocated.
class QuadtreeFitter {
 public:
  /// Throws std::invalid_argument when `options` fail their check or `camera` is null.
  QuadtreeFitter(std::shared_ptr<const Camera> camera, const QuadtreeFitterOptions& options);
  ~QuadtreeFitter();
  QuadtreeFitter(QuadtreeFitter&&) noexcept;
  QuadtreeFitter& operator=(QuadtreeFitter&&) noexcept;

  /// Fits `depth` [m] (NaN, infinite or <= 0: none), camera height x width. Tiles come breadth
  /// first, so whatever ends the fit early leaves a coarser cloud. `options.time_budget` and
  /// `options.byte_budget` are the caller's to turn into a `FitBudget`: the core has no clock.
  /// Throws std::invalid_argument when the size is not the camera's.
  [[nodiscard]] PlaneCloud fit(ImageView<float> depth, const FitBudget& budget = {});
  /// The same for `depth` [mm] (0: none), the 16UC1 encoding.
  [[nodiscard]] PlaneCloud fit(ImageView<std::uint16_t> depth, const FitBudget& budget = {});

  [[nodiscard]] const QuadtreeFitterOptions& options() const;
  [[nodiscard]] const Camera& camera() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planecloud
