// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/plan_canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace planecloud {
namespace {

constexpr int kOversampling = 2;
constexpr int kFractionBits = 4;  // of OpenCV's line coordinates
constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
constexpr double kFontHeight = 22.0;  // of its capitals at scale 1 [px]

cv::Scalar toScalar(const PlanColor& color) {
  return {double(color.b), double(color.g), double(color.r)};
}

/// Oversampled fixed-point coordinates of picture coordinates.
cv::Point toFixed(const Eigen::Vector2d& point) {
  constexpr double kScale = kOversampling * (1 << kFractionBits);
  return {static_cast<int>(std::lround(kScale * point.x())),
          static_cast<int>(std::lround(kScale * point.y()))};
}

int oversampled(double pixels) {
  return std::max(1, static_cast<int>(std::lround(kOversampling * pixels)));
}

/// The dashes of a line.
std::vector<std::vector<Eigen::Vector2d>> cutIntoDashes(const std::vector<Eigen::Vector2d>& points,
                                                        double dash) {
  std::vector<std::vector<Eigen::Vector2d>> dashes;
  bool drawing = true;
  double left = dash;
  dashes.push_back({points.front()});
  for (std::size_t i = 1; i < points.size(); ++i) {
    Eigen::Vector2d from = points[i - 1];
    double length = (points[i] - from).norm();
    while (length > left) {
      from += (points[i] - from) * (left / length);
      length -= left;
      if (drawing) dashes.back().push_back(from);
      drawing = !drawing;
      if (drawing) dashes.push_back({from});
      left = dash;
    }
    left -= length;
    if (drawing) dashes.back().push_back(points[i]);
  }
  return dashes;
}

}  // namespace

PlanColor PlanColor::thinned(double share) const {
  const auto thin = [share](int value) {
    return static_cast<int>(std::lround(255.0 + share * (value - 255.0)));
  };
  return {thin(r), thin(g), thin(b)};
}

PlanCanvas::PlanCanvas(const PlanLayout& layout) : layout_(layout) {
  const Eigen::Vector2d size = layout.pixels_per_metre * (layout.upper - layout.lower);
  width_ = static_cast<int>(std::ceil(size.x())) + 2 * layout.margin;
  height_ =
      static_cast<int>(std::ceil(size.y())) + 2 * layout.margin + layout.header + layout.footer;
  image_ = cv::Mat(kOversampling * height_, kOversampling * width_, CV_8UC3, cv::Scalar::all(255));
}

Eigen::Vector2d PlanCanvas::toPixels(const Eigen::Vector2d& point) const {
  const double scale = layout_.pixels_per_metre;
  return {layout_.margin + scale * (point.x() - layout_.lower.x()),
          layout_.margin + layout_.header + scale * (layout_.upper.y() - point.y())};
}

void PlanCanvas::drawPlan(const cv::Mat& image) {
  const Eigen::Vector2d size = layout_.pixels_per_metre * (layout_.upper - layout_.lower);
  const cv::Rect place(kOversampling * layout_.margin,
                       kOversampling * (layout_.margin + layout_.header), oversampled(size.x()),
                       oversampled(size.y()));
  cv::Mat target = image_(place);
  cv::resize(image, target, place.size(), 0.0, 0.0, cv::INTER_LINEAR);
}

void PlanCanvas::drawLine(const std::vector<Eigen::Vector2d>& points, const PlanStroke& stroke) {
  if (points.size() < 2) return;
  const auto lines = stroke.dash > 0.0 ? cutIntoDashes(points, stroke.dash)
                                       : std::vector<std::vector<Eigen::Vector2d>>{points};
  for (const std::vector<Eigen::Vector2d>& line : lines) {
    std::vector<cv::Point> fixed;
    for (const Eigen::Vector2d& point : line) fixed.push_back(toFixed(point));
    cv::polylines(image_, fixed, false, toScalar(stroke.color), oversampled(stroke.width),
                  cv::LINE_AA, kFractionBits);
  }
}

void PlanCanvas::drawDisc(const Eigen::Vector2d& centre, double radius, const PlanColor& color) {
  constexpr double kScale = kOversampling * (1 << kFractionBits);
  cv::circle(image_, toFixed(centre), static_cast<int>(std::lround(kScale * radius)),
             toScalar(color), cv::FILLED, cv::LINE_AA, kFractionBits);
}

void PlanCanvas::drawText(const std::string& text, const Eigen::Vector2d& origin, double size,
                          const PlanColor& color) {
  const cv::Point place(static_cast<int>(std::lround(kOversampling * origin.x())),
                        static_cast<int>(std::lround(kOversampling * origin.y())));
  cv::putText(image_, text, place, kFont, kOversampling * size / kFontHeight, toScalar(color),
              std::max(1, static_cast<int>(std::lround(kOversampling * size / 18.0))), cv::LINE_AA);
}

double PlanCanvas::textWidth(const std::string& text, double size) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, size / kFontHeight, 1, &baseline).width;
}

cv::Mat PlanCanvas::picture() const {
  cv::Mat picture;
  cv::resize(image_, picture, {width_, height_}, 0.0, 0.0, cv::INTER_AREA);
  return picture;
}

}  // namespace planecloud
