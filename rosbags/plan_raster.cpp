// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/plan_raster.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace planecloud {
namespace {

constexpr double kRasterOversampling = 2.0;
constexpr float kFacesUp = 0.8F;          // least z of the normal
constexpr float kSteep = 0.35F;           // largest |z| of the normal of a wall
constexpr float kFloorTolerance = 0.12F;  // [m]
constexpr double kFloorShare = 0.16;      // of the robot's colour
constexpr double kFurnitureShare = 0.5;
constexpr double kWallQuantile = 0.75;            // of the evidence at which a wall is nearly black
const cv::Vec3f kWallColor(66.0F, 52.0F, 42.0F);  // blue first

cv::Vec3f toVector(const PlanColor& color) {
  return {static_cast<float>(color.b), static_cast<float>(color.g), static_cast<float>(color.r)};
}

/// The area above which `share` of the touched pixels do not come.
float areaQuantile(const cv::Mat1f& area, double share) {
  std::vector<float> touched;
  for (const float value : area) {
    if (value > 0.0F) touched.push_back(value);
  }
  if (touched.empty()) return 1.0F;
  const auto place = touched.begin() +
                     static_cast<std::ptrdiff_t>(share * static_cast<double>(touched.size() - 1));
  std::nth_element(touched.begin(), place, touched.end());
  return *place;
}

/// White with a line every metre.
cv::Mat3f makePaper(int rows, int columns, const PlanLayout& layout, double scale) {
  cv::Mat3f paper(rows, columns, cv::Vec3f(255.0F, 255.0F, 255.0F));
  const cv::Vec3f line(240.0F, 236.0F, 233.0F);
  for (double x = std::ceil(layout.lower.x()); x < layout.upper.x(); x += 1.0) {
    paper.col(std::min(columns - 1, static_cast<int>(scale * (x - layout.lower.x())))) = line;
  }
  for (double y = std::ceil(layout.lower.y()); y < layout.upper.y(); y += 1.0) {
    paper.row(std::min(rows - 1, static_cast<int>(scale * (layout.upper.y() - y)))) = line;
  }
  return paper;
}

}  // namespace

PlanRaster::PlanRaster(const PlanLayout& layout, std::vector<PlanColor> robot_colors,
                       float floor_height)
    : layout_(layout),
      robot_colors_(std::move(robot_colors)),
      floor_height_(floor_height),
      scale_(kRasterOversampling * layout.pixels_per_metre),
      columns_(static_cast<int>(std::ceil(scale_ * (layout.upper.x() - layout.lower.x())))),
      rows_(static_cast<int>(std::ceil(scale_ * (layout.upper.y() - layout.lower.y())))) {
  for (Layer* layer : {&floor_, &furniture_, &walls_}) {
    layer->area = cv::Mat1f(rows_, columns_, 0.0F);
    layer->color = cv::Mat3f(rows_, columns_, cv::Vec3f(0.0F, 0.0F, 0.0F));
  }
}

void PlanRaster::add(const SurfaceSample& sample) {
  const Eigen::Vector2d ground = sample.position.head<2>().cast<double>();
  const auto x = static_cast<int>(std::floor(scale_ * (ground.x() - layout_.lower.x())));
  const auto y = static_cast<int>(std::floor(scale_ * (layout_.upper.y() - ground.y())));
  if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return;
  // Neither upright nor level: the edges of things, and far surfaces that noise has turned.
  if (sample.normal.z() < kFacesUp && std::abs(sample.normal.z()) > kSteep) return;
  const PlanColor& color = robot_colors_[static_cast<std::size_t>(sample.robot)];
  if (std::abs(sample.normal.z()) < kSteep) {
    walls_.add(x, y, sample.area, 0.75F * kWallColor + 0.25F * toVector(color));
  } else if (sample.position.z() > floor_height_ + kFloorTolerance) {
    furniture_.add(x, y, sample.area, toVector(color.thinned(kFurnitureShare)));
  } else {
    floor_.add(x, y, sample.area, toVector(color.thinned(kFloorShare)));
  }
}

/// Single pixels between samples closed, edges smooth.
void PlanRaster::smooth(Layer& layer, double sigma) {
  cv::GaussianBlur(layer.area, layer.area, {}, sigma);
  cv::GaussianBlur(layer.color, layer.color, {}, sigma);
}

/// Lays the layer over the plan and gives it up; a pixel with `full` area covers 86 % of what is
/// below.
void PlanRaster::cover(cv::Mat3f& plan, Layer& layer, float full) {
  for (int y = 0; y < plan.rows; ++y) {
    for (int x = 0; x < plan.cols; ++x) {
      const float area = layer.area(y, x);
      if (area <= 0.0F) continue;
      const float share = 1.0F - std::exp(-2.0F * area / full);
      plan(y, x) = (1.0F - share) * plan(y, x) + share / area * layer.color(y, x);
    }
  }
  layer = {};
}

cv::Mat PlanRaster::paint() && {
  const auto pixel_area = static_cast<float>(1.0 / (scale_ * scale_));
  cv::Mat3f plan = makePaper(rows_, columns_, layout_, scale_);
  smooth(floor_, 3.0);
  cover(plan, floor_, pixel_area);
  smooth(furniture_, 1.5);
  cover(plan, furniture_, 2.0F * pixel_area);
  smooth(walls_, 0.8);
  const float full = areaQuantile(walls_.area, kWallQuantile);
  cover(plan, walls_, full);
  cv::Mat picture;
  plan.convertTo(picture, CV_8UC3);
  return picture;
}

}  // namespace planecloud
