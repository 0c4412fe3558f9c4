// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace planecloud {

/// A colour with shares of red, green, blue in [0, 255].
struct PlanColor {
  int r = 0;
  int g = 0;
  int b = 0;
  /// This colour thinned with white: `share` of it, [0, 1].
  [[nodiscard]] PlanColor thinned(double share) const;
};

/// Size and place of a picture of the ground from above.
struct PlanLayout {
  Eigen::Vector2d lower = Eigen::Vector2d::Zero();  ///< left bottom corner of the plan [m]
  Eigen::Vector2d upper = Eigen::Vector2d::Ones();  ///< right top corner [m]
  double pixels_per_metre = 100.0;
  int margin = 36;  ///< around the plan [px]
  int header = 72;  ///< above it [px]
  int footer = 84;  ///< below it [px]
};

/// How a line looks.
struct PlanStroke {
  PlanColor color;
  double width = 2.0;  ///< [px]
  double dash = 0.0;   ///< length of a dash and of the gap after it [px], 0: solid
};

/// A picture that is drawn in metres or pixels at twice its size, then made smaller: smooth lines
/// and text.
class PlanCanvas {
 public:
  explicit PlanCanvas(const PlanLayout& layout);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Picture coordinates [px] of a point on the ground [m].
  [[nodiscard]] Eigen::Vector2d toPixels(const Eigen::Vector2d& point) const;

  /// Lays `image` (8UC3, blue first; rows from the top) over the plan's rectangle, stretched.
  void drawPlan(const cv::Mat& image);
  /// A line through `points` [px].
  void drawLine(const std::vector<Eigen::Vector2d>& points, const PlanStroke& stroke);
  void drawDisc(const Eigen::Vector2d& centre, double radius, const PlanColor& color);
  /// Text whose base line begins at `origin` [px], letters `size` px high.
  void drawText(const std::string& text, const Eigen::Vector2d& origin, double size,
                const PlanColor& color);
  /// Width of `text` [px].
  [[nodiscard]] static double textWidth(const std::string& text, double size);

  /// The finished picture, 8UC3, blue first.
  [[nodiscard]] cv::Mat picture() const;

 private:
  PlanLayout layout_;
  int width_ = 0;
  int height_ = 0;
  cv::Mat image_;  ///< at twice the size
};

}  // namespace planecloud
