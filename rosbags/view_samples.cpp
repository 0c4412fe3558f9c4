// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/view_samples.h"

#include <algorithm>
#include <cmath>

namespace planecloud {
namespace {

constexpr int kStep = 20;                    // [px]
constexpr double kDepthAgreement = 0.1;      // [m]
constexpr double kRelativeAgreement = 0.05;  // of the depth

/// First sample at or after pixel `x`; samples lie in the middle of their cells.
int firstSample(int x) { return std::max(0, (x - kStep / 2 + kStep - 1) / kStep); }
int samplePixel(int index) { return index * kStep + kStep / 2; }

}  // namespace

// Overlap is a coarse measure: the lens distortion, a few pixels, is left out.
ViewSamples::ViewSamples(const PlaneCloud& cloud)
    : camera_(cloud.camera),
      columns_(cloud.camera.width / kStep),
      rows_(cloud.camera.height / kStep),
      depths_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0.0F) {
  for (const PlanarTile& tile : cloud.tiles) {
    const TileRect& rect = tile.rect;
    for (int r = firstSample(rect.y); r < rows_ && samplePixel(r) < rect.y + rect.height; ++r) {
      for (int c = firstSample(rect.x); c < columns_ && samplePixel(c) < rect.x + rect.width; ++c) {
        const double u = (samplePixel(c) - camera_.cx) / camera_.fx;
        const double v = (samplePixel(r) - camera_.cy) / camera_.fy;
        const float z = tile.depthAt(static_cast<float>(u), static_cast<float>(v));
        if (!(z > 0.0F) || !std::isfinite(z)) continue;
        depths_[static_cast<std::size_t>(r * columns_ + c)] = z;
        points_.emplace_back(z * u, z * v, z);
      }
    }
  }
}

bool ViewSamples::sees(const Eigen::Vector3d& point) const {
  if (point.z() <= 0.0) return false;
  const double x = camera_.fx * point.x() / point.z() + camera_.cx;
  const double y = camera_.fy * point.y() / point.z() + camera_.cy;
  if (x < 0.0 || y < 0.0) return false;
  const auto column = static_cast<int>(x / kStep);
  const auto row = static_cast<int>(y / kStep);
  if (column >= columns_ || row >= rows_) return false;
  const double z = static_cast<double>(depths_[static_cast<std::size_t>(row * columns_ + column)]);
  const double agreement = std::max(kDepthAgreement, kRelativeAgreement * point.z());
  return z > 0.0 && std::abs(z - point.z()) <= agreement;
}

double ViewSamples::shareSeenBy(const ViewSamples& other,
                                const Eigen::Isometry3d& T_other_this) const {
  if (points_.empty()) return 0.0;
  const auto seen = std::count_if(points_.begin(), points_.end(), [&](const Eigen::Vector3d& p) {
    return other.sees(T_other_this * p);
  });
  return static_cast<double>(seen) / static_cast<double>(points_.size());
}

}  // namespace planecloud
