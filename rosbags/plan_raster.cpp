// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/plan_raster.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

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

/// What is seen of one kind of surface: its area and its colour by area.
struct Layer {
  Layer(int rows, int columns)
      : area(rows, columns, 0.0F), color(rows, columns, cv::Vec3f(0.0F, 0.0F, 0.0F)) {}
  void add(int x, int y, float added, const cv::Vec3f& tint) {
    area(y, x) += added;
    color(y, x) += added * tint;
  }
  cv::Mat1f area;
  cv::Mat3f color;
};

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

/// Lays the layer over the plan; a pixel with `full` area covers 86 % of what is below.
void cover(cv::Mat3f& plan, const Layer& layer, float full) {
  for (int y = 0; y < plan.rows; ++y) {
    for (int x = 0; x < plan.cols; ++x) {
      const float area = layer.area(y, x);
      if (area <= 0.0F) continue;
      const float share = 1.0F - std::exp(-2.0F * area / full);
      plan(y, x) = (1.0F - share) * plan(y, x) + share / area * layer.color(y, x);
    }
  }
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

/// Single pixels between samples closed, edges smooth.
void smooth(Layer& layer, double sigma) {
  cv::GaussianBlur(layer.area, layer.area, {}, sigma);
  cv::GaussianBlur(layer.color, layer.color, {}, sigma);
}

}  // namespace

cv::Mat paintPlan(const std::vector<SurfaceSample>& samples,
                  const std::vector<PlanColor>& robot_colors, const PlanLayout& layout) {
  const double scale = kRasterOversampling * layout.pixels_per_metre;
  const Eigen::Vector2d size = scale * (layout.upper - layout.lower);
  const auto columns = static_cast<int>(std::ceil(size.x()));
  const auto rows = static_cast<int>(std::ceil(size.y()));
  const float floor_height = findFloorHeight(samples);
  Layer floor(rows, columns), furniture(rows, columns), walls(rows, columns);
  for (const SurfaceSample& sample : samples) {
    const Eigen::Vector2d ground = sample.position.head<2>().cast<double>();
    const auto x = static_cast<int>(std::floor(scale * (ground.x() - layout.lower.x())));
    const auto y = static_cast<int>(std::floor(scale * (layout.upper.y() - ground.y())));
    if (x < 0 || y < 0 || x >= columns || y >= rows) continue;
    // Neither upright nor level: the edges of things, and far surfaces that noise has turned.
    if (sample.normal.z() < kFacesUp && std::abs(sample.normal.z()) > kSteep) continue;
    const PlanColor& color = robot_colors[static_cast<std::size_t>(sample.robot)];
    if (std::abs(sample.normal.z()) < kSteep) {
      walls.add(x, y, sample.area, 0.75F * kWallColor + 0.25F * toVector(color));
    } else if (sample.position.z() > floor_height + kFloorTolerance) {
      furniture.add(x, y, sample.area, toVector(color.thinned(kFurnitureShare)));
    } else {
      floor.add(x, y, sample.area, toVector(color.thinned(kFloorShare)));
    }
  }
  const auto pixel_area = static_cast<float>(1.0 / (scale * scale));
  smooth(floor, 3.0);
  smooth(furniture, 1.5);
  smooth(walls, 0.8);
  cv::Mat3f plan = makePaper(rows, columns, layout, scale);
  cover(plan, floor, pixel_area);
  cover(plan, furniture, 2.0F * pixel_area);
  cover(plan, walls, areaQuantile(walls.area, kWallQuantile));
  cv::Mat picture;
  plan.convertTo(picture, CV_8UC3);
  return picture;
}

}  // namespace planecloud
