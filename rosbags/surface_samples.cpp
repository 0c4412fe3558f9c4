// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace planecloud {
namespace {

constexpr int kMostSamplesPerSide = 64;
constexpr float kLeastIncidence = 0.08F;  // cosine: flatter views are smeared along the ray
constexpr float kHorizontal = 0.9F;       // least |z| of a horizontal surface's normal
constexpr float kVertical = 0.3F;         // largest |z| of a wall's normal
constexpr float kHeightStep = 0.05F;      // [m]
constexpr double kFloorShare = 0.25;      // of the largest surface's area

using SampleVisitor = std::function<void(const SurfaceSample&)>;

/// The keyframe whose tiles are sampled.
struct View {
  CameraIntrinsics camera;
  Eigen::Isometry3f T_view_camera;
  int robot = 0;
};

int samplesAlong(int pixels, double focal_length, double depth, double spacing) {
  const double length = pixels * depth / focal_length;
  return std::clamp(static_cast<int>(std::ceil(length / spacing)), 1, kMostSamplesPerSide);
}

void sampleTile(const PlanarTile& tile, const View& view, const SurfaceSampling& sampling,
                const SampleVisitor& visit) {
  const CameraIntrinsics& camera = view.camera;
  const TileRect& rect = tile.rect;
  const auto u_at = [&](double x) { return static_cast<float>((x - camera.cx) / camera.fx); };
  const auto v_at = [&](double y) { return static_cast<float>((y - camera.cy) / camera.fy); };
  const float centre_depth =
      tile.depthAt(u_at(rect.x + 0.5 * rect.width), v_at(rect.y + 0.5 * rect.height));
  if (!(centre_depth > 0.0F) || centre_depth > static_cast<float>(sampling.range)) return;
  const Eigen::Vector3f normal = tile.plane().head<3>().cast<float>();
  const int columns = samplesAlong(rect.width, camera.fx, centre_depth, sampling.spacing);
  const int rows = samplesAlong(rect.height, camera.fy, centre_depth, sampling.spacing);
  const double pixels = static_cast<double>(rect.area()) / (columns * rows);
  const auto solid_angle = static_cast<float>(pixels / (camera.fx * camera.fy));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float u = u_at(rect.x + rect.width * (column + 0.5) / columns - 0.5);
      const float v = v_at(rect.y + rect.height * (row + 0.5) / rows - 0.5);
      const float z = tile.depthAt(u, v);
      if (!(z > 0.0F) || z > static_cast<float>(sampling.range)) continue;
      const Eigen::Vector3f ray(u, v, 1.0F);
      const float slope = std::abs(normal.dot(ray));
      if (slope < kLeastIncidence * ray.norm()) continue;
      visit({view.T_view_camera * (z * ray), view.T_view_camera.linear() * normal,
             z * z * solid_angle / slope, view.robot});
    }
  }
}

}  // namespace

void visitSurfaces(const MapSnapshot& map, const SurfaceSampling& sampling,
                   const SampleVisitor& visit) {
  for (const MapSnapshot::Node& node : map.nodes) {
    const auto robot =
        std::find(sampling.robots.begin(), sampling.robots.end(), node.keyframe->id.robot);
    if (node.component != sampling.component || robot == sampling.robots.end()) continue;
    View view;
    view.camera = node.keyframe->planes.camera();
    view.T_view_camera = (sampling.T_view_map * node.T_map_camera).cast<float>();
    view.robot = static_cast<int>(robot - sampling.robots.begin());
    const PlaneCloud planes = *node.keyframe->planes;
    for (const PlanarTile& tile : planes.tiles) {
      sampleTile(tile, view, sampling, visit);
    }
  }
}

std::vector<SurfaceSample> sampleSurfaces(const MapSnapshot& map, const SurfaceSampling& sampling) {
  std::vector<SurfaceSample> samples;
  visitSurfaces(map, sampling, [&](const SurfaceSample& sample) { samples.push_back(sample); });
  return samples;
}

double alignWallsWithAxes(const std::vector<SurfaceSample>& samples) {
  // Angles modulo a quarter turn: four times the angle makes them one direction.
  std::complex<double> sum = 0.0;
  for (const SurfaceSample& sample : samples) {
    if (std::abs(sample.normal.z()) > kVertical) continue;
    const double angle =
        std::atan2(static_cast<double>(sample.normal.y()), static_cast<double>(sample.normal.x()));
    sum += std::polar(static_cast<double>(sample.area), 4.0 * angle);
  }
  return std::abs(sum) > 0.0 ? -0.25 * std::arg(sum) : 0.0;
}

float findFloorHeight(const std::vector<SurfaceSample>& samples) {
  if (samples.empty()) return 0.0F;
  const auto lower = [](const SurfaceSample& a, const SurfaceSample& b) {
    return a.position.z() < b.position.z();
  };
  const auto [lowest, highest] = std::minmax_element(samples.begin(), samples.end(), lower);
  const float base = lowest->position.z();
  const auto bin = [&](float z) { return static_cast<std::size_t>((z - base) / kHeightStep); };
  std::vector<double> area(bin(highest->position.z()) + 1, 0.0);
  for (const SurfaceSample& sample : samples) {
    if (sample.normal.z() < kHorizontal) continue;
    area[bin(sample.position.z())] += static_cast<double>(sample.area);
  }
  const double least = kFloorShare * *std::max_element(area.begin(), area.end());
  if (least <= 0.0) return base;
  const auto floor = std::find_if(area.begin(), area.end(), [&](double a) { return a >= least; });
  return base + kHeightStep * (static_cast<float>(floor - area.begin()) + 0.5F);
}

}  // namespace planecloud
