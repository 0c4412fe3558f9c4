// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/patch_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planecloud {
namespace {

constexpr double kFarAway = 1e6;  // [m]

}  // namespace

void PatchColumns::add(const Eigen::Vector3d& centroid, const Eigen::Vector3d& normal,
                       double patch_radius) {
  centroid_x.push_back(static_cast<float>(centroid.x()));
  centroid_y.push_back(static_cast<float>(centroid.y()));
  centroid_z.push_back(static_cast<float>(centroid.z()));
  normal_x.push_back(static_cast<float>(normal.x()));
  normal_y.push_back(static_cast<float>(normal.y()));
  normal_z.push_back(static_cast<float>(normal.z()));
  radius.push_back(static_cast<float>(patch_radius));
  size = radius.size();
}

void PatchColumns::pad() {
  while (size % kPadding != 0) {
    add(Eigen::Vector3d::Constant(kFarAway), Eigen::Vector3d::UnitZ(), 0.0);
  }
}

int nearestPatchScalar(const PatchColumns& patches, const PatchQuery& query) {
  int best = -1;
  float best_cost = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < patches.size; ++i) {
    const Eigen::Vector3f normal(patches.normal_x[i], patches.normal_y[i], patches.normal_z[i]);
    const float cosine = normal.dot(query.normal);
    const Eigen::Vector3f offset =
        query.centroid -
        Eigen::Vector3f(patches.centroid_x[i], patches.centroid_y[i], patches.centroid_z[i]);
    const float distance = normal.dot(offset);
    const float in_plane = std::sqrt(std::max(0.0F, offset.squaredNorm() - distance * distance));
    const float gap = std::max(0.0F, in_plane - patches.radius[i] - query.radius);
    const float surface = distance * distance + gap * gap;
    if (surface > query.max_squared_distance || cosine < query.min_cosine) continue;
    const float cost = surface + query.squared_normal_length * (2.0F - 2.0F * cosine);
    if (cost < best_cost) {
      best_cost = cost;
      best = static_cast<int>(i);
    }
  }
  return best;
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
int nearestPatch(const PatchColumns& patches, const PatchQuery& query) {
  return nearestPatchScalar(patches, query);
}
#endif

}  // namespace planecloud
