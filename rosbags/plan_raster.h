// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "planecloud_slam/rosbags/plan_canvas.h"
#include "planecloud_slam/rosbags/surface_samples.h"

namespace planecloud {

/// Surfaces as a plan from above at twice the resolution of its layout: floor in thin, furniture in
/// stronger tints of the robots' colours, walls dark where much of them was seen; ceilings are left
/// out.
class PlanRaster {
 public:
  /// `robot_colors` by SurfaceSample::robot; `floor_height` [m].
  PlanRaster(const PlanLayout& layout, std::vector<PlanColor> robot_colors, float floor_height);

  void add(const SurfaceSample& sample);
  /// What was added, 8UC3, blue first. Used up by it: the layers of a large plan take 100 MB each.
  [[nodiscard]] cv::Mat paint() &&;

 private:
  /// What is seen of one kind of surface: its area and its colour by area.
  struct Layer {
    cv::Mat1f area;
    cv::Mat3f color;
    void add(int x, int y, float added, const cv::Vec3f& tint) {
      area(y, x) += added;
      color(y, x) += added * tint;
    }
  };

  static void smooth(Layer& layer, double sigma);
  static void cover(cv::Mat3f& plan, Layer& layer, float full);

  PlanLayout layout_;
  std::vector<PlanColor> robot_colors_;
  float floor_height_;
  double scale_;  ///< [px/m]
  int columns_;
  int rows_;
  Layer floor_;
  Layer furniture_;
  Layer walls_;
};

}  // namespace planecloud
