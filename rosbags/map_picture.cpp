// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/map_picture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "planecloud_slam/backend_node/robot_colors.h"
#include "planecloud_slam/rosbags/plan_canvas.h"
#include "planecloud_slam/rosbags/plan_legend.h"
#include "planecloud_slam/rosbags/plan_raster.h"
#include "planecloud_slam/rosbags/surface_samples.h"

namespace planecloud {
namespace {

constexpr double kLargestWidth = 1600.0;   // of the plan [px]
constexpr double kLargestHeight = 1000.0;  // [px]
constexpr double kSmallestWidth = 760.0;   // so that the legend fits [px]
constexpr double kFinestScale = 320.0;     // [px/m]
constexpr double kOutliers = 0.002;        // share of the samples left outside at each side
constexpr double kCoarseSpacing = 0.05;    // of samples that tell the plan's size [m]
constexpr double kFineSpacing = 0.6;       // of samples that are painted [px]
constexpr double kBorder = 0.25;           // around what is seen [m]

constexpr PlanColor kTrue{186, 192, 200};
constexpr PlanColor kGrey{96, 104, 114};
constexpr PlanColor kClosure{20, 148, 92};
constexpr PlanColor kFalseClosure{222, 28, 36};

/// The colours that robots have in every picture of the map.
std::vector<PlanColor> colorsOf(const MapSnapshot& map, const std::vector<PictureRobot>& robots) {
  const std::map<std::string, RobotColor> palette = robotColors(map);
  std::vector<PlanColor> colors;
  for (const PictureRobot& robot : robots) {
    const auto found = palette.find(robot.name);
    colors.push_back(found == palette.end()
                         ? kGrey
                         : PlanColor{found->second.r, found->second.g, found->second.b});
  }
  return colors;
}

int largestComponent(const MapSnapshot& map) {
  std::map<int, int> sizes;
  for (const MapSnapshot::Node& node : map.nodes) ++sizes[node.component];
  int largest = 0;
  for (const auto& [component, size] : sizes) {
    if (size > sizes[largest]) largest = component;
  }
  return largest;
}

/// The interval that holds all `values` but the share `outliers` at each end.
std::pair<double, double> robustRange(std::vector<double> values, double outliers) {
  std::sort(values.begin(), values.end());
  const auto skip = static_cast<std::size_t>(outliers * static_cast<double>(values.size()));
  return {values[skip], values[values.size() - 1 - skip]};
}

/// Where the plan ends: all ways, and what is seen but for outliers.
PlanLayout makeLayout(const std::vector<SurfaceSample>& samples,
                      const std::vector<Eigen::Vector2d>& ways) {
  PlanLayout layout;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> seen;
    for (const SurfaceSample& sample : samples) {
      seen.push_back(static_cast<double>(sample.position(axis)));
    }
    if (seen.empty()) seen.push_back(0.0);
    auto [lower, upper] = robustRange(std::move(seen), kOutliers);
    for (const Eigen::Vector2d& point : ways) {
      lower = std::min(lower, point(axis));
      upper = std::max(upper, point(axis));
    }
    layout.lower(axis) = lower - kBorder;
    layout.upper(axis) = upper + kBorder;
  }
  const Eigen::Vector2d size = layout.upper - layout.lower;
  layout.pixels_per_metre =
      std::min({kLargestWidth / size.x(), kLargestHeight / size.y(), kFinestScale});
  const double missing = kSmallestWidth / layout.pixels_per_metre - size.x();
  if (missing > 0.0) {
    layout.lower.x() -= 0.5 * missing;
    layout.upper.x() += 0.5 * missing;
  }
  return layout;
}

/// A map on its way onto paper.
class MapPainter {
 public:
  MapPainter(const MapSnapshot& map, const MapPicture& picture)
      : map_(map),
        picture_(picture),
        colors_(colorsOf(map, picture.robots)),
        component_(largestComponent(map)),
        T_view_map_(picture.T_view_map) {
    samples_ = sampleSurfaces(map_, sampling(kCoarseSpacing));
    turn(alignWallsWithAxes(samples_));
    if (isTall()) turn(0.5 * M_PI);
    layout_ = makeLayout(samples_, allWays());
  }

  cv::Mat paint() {
    PlanCanvas canvas(layout_);
    canvas.drawPlan(paintSurfaces());
    for (std::size_t i = 0; i < picture_.robots.size(); ++i) drawRobot(canvas, i);
    drawClosures(canvas);
    drawHeader(canvas, layout_, picture_.title, picture_.subtitle);
    drawScaleBar(canvas, layout_);
    drawLegend(canvas, layout_, legend());
    return canvas.picture();
  }

 private:
  [[nodiscard]] SurfaceSampling sampling(double spacing) const {
    SurfaceSampling sampling;
    sampling.spacing = spacing;
    sampling.component = component_;
    sampling.T_view_map = T_view_map_;
    for (const PictureRobot& robot : picture_.robots) sampling.robots.push_back(robot.name);
    return sampling;
  }

  [[nodiscard]] cv::Mat paintSurfaces() const {
    PlanRaster raster(layout_, colors_, findFloorHeight(samples_));
    visitSurfaces(map_, sampling(kFineSpacing / layout_.pixels_per_metre),
                  [&](const SurfaceSample& sample) { raster.add(sample); });
    return std::move(raster).paint();
  }

  void turn(double angle) {
    const Eigen::AngleAxisd rotation(angle, Eigen::Vector3d::UnitZ());
    T_view_map_ = rotation * T_view_map_;
    const Eigen::Matrix3f R = rotation.toRotationMatrix().cast<float>();
    for (SurfaceSample& sample : samples_) {
      sample.position = R * sample.position;
      sample.normal = R * sample.normal;
    }
  }

  [[nodiscard]] bool isTall() const {
    const PlanLayout layout = makeLayout(samples_, allWays());
    const Eigen::Vector2d size = layout.upper - layout.lower;
    return size.y() > size.x();
  }

  [[nodiscard]] Eigen::Vector2d toGround(const Eigen::Vector3d& point) const {
    return (T_view_map_ * point).head<2>();
  }

  [[nodiscard]] std::vector<Eigen::Vector2d> toGround(const Trajectory& way) const {
    std::vector<Eigen::Vector2d> points;
    for (const StampedPose& pose : way) points.push_back(toGround(pose.pose.translation()));
    return points;
  }

  [[nodiscard]] std::vector<Eigen::Vector2d> allWays() const {
    std::vector<Eigen::Vector2d> points;
    for (const PictureRobot& robot : picture_.robots) {
      for (const Trajectory* way : {&robot.optimised, &robot.odometry, &robot.ground_truth}) {
        const std::vector<Eigen::Vector2d> own = toGround(*way);
        points.insert(points.end(), own.begin(), own.end());
      }
    }
    return points;
  }

  void drawWay(PlanCanvas& canvas, const Trajectory& way, const PlanStroke& stroke) const {
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector2d& point : toGround(way)) pixels.push_back(canvas.toPixels(point));
    canvas.drawLine(pixels, stroke);
  }

  void drawRobot(PlanCanvas& canvas, std::size_t index) const {
    const PictureRobot& robot = picture_.robots[index];
    const PlanColor& color = colors_[index];
    drawWay(canvas, robot.ground_truth, truthStroke());
    drawWay(canvas, robot.odometry, odometryStroke(color));
    drawWay(canvas, robot.optimised, optimisedStroke(color));
    if (robot.optimised.empty()) return;
    const Eigen::Vector2d start =
        canvas.toPixels(toGround(robot.optimised.front().pose.translation()));
    canvas.drawDisc(start, 8.0, {255, 255, 255});
    canvas.drawDisc(start, 6.0, color);
  }

  void drawClosures(PlanCanvas& canvas) const {
    std::map<KeyframeId, Eigen::Vector2d> places;
    for (const MapSnapshot::Node& node : map_.nodes) {
      if (node.component != component_) continue;
      places[node.keyframe->id] = canvas.toPixels(toGround(node.T_map_camera.translation()));
    }
    for (const JudgedClosure& closure : picture_.closures) {
      const auto from = places.find(closure.edge.from);
      const auto to = places.find(closure.edge.to);
      if (from == places.end() || to == places.end()) continue;
      const PlanStroke stroke = closureStroke(closure.verdict == ClosureTruth::kFalse);
      canvas.drawLine({from->second, to->second}, stroke);
      canvas.drawDisc(from->second, 2.2, stroke.color);
      canvas.drawDisc(to->second, 2.2, stroke.color);
    }
  }

  [[nodiscard]] std::vector<LegendEntry> legend() const {
    std::vector<LegendEntry> entries;
    bool has_truth = false;
    for (std::size_t i = 0; i < picture_.robots.size(); ++i) {
      entries.push_back({picture_.robots[i].name, optimisedStroke(colors_[i])});
      has_truth = has_truth || !picture_.robots[i].ground_truth.empty();
    }
    entries.push_back({"odometry alone", odometryStroke(kGrey)});
    if (has_truth) entries.push_back({"ground truth", truthStroke()});
    bool has_closure = false;
    bool has_false_closure = false;
    for (const JudgedClosure& closure : picture_.closures) {
      const bool is_false = closure.verdict == ClosureTruth::kFalse;
      has_closure = has_closure || !is_false;
      has_false_closure = has_false_closure || is_false;
    }
    if (has_closure) entries.push_back({"loop closure", closureStroke(false)});
    if (has_false_closure) entries.push_back({"false loop closure", closureStroke(true)});
    return entries;
  }

  static PlanStroke optimisedStroke(const PlanColor& color) { return {color, 2.6}; }
  static PlanStroke odometryStroke(const PlanColor& color) {
    return {color.thinned(0.75), 1.5, 5.0};
  }
  static PlanStroke truthStroke() { return {kTrue, 7.0}; }
  static PlanStroke closureStroke(bool is_false) {
    return is_false ? PlanStroke{kFalseClosure, 3.0} : PlanStroke{kClosure, 1.3};
  }

  const MapSnapshot& map_;
  const MapPicture& picture_;
  const std::vector<PlanColor> colors_;
  const int component_;
  Eigen::Isometry3d T_view_map_;
  std::vector<SurfaceSample> samples_;  ///< coarse
  PlanLayout layout_;
};

}  // namespace

cv::Mat drawMap(const MapSnapshot& map, const MapPicture& picture) {
  return MapPainter(map, picture).paint();
}

}  // namespace planecloud
