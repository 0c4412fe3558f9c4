// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/view_search.h"

#include <algorithm>
#include <cmath>

#include "planecloud_slam/icap/view_search_simd.h"

namespace planecloud {
namespace {

/// A patch where the motion puts it.
struct Moved {
  Eigen::Vector3f centroid;
  Eigen::Vector3f normal;
};

Moved moved(const MovedPatches& patches, std::size_t i) {
  const PatchColumns& p = patches.patches;
  return {
      patches.R_view_patch * Eigen::Vector3f(p.centroid_x[i], p.centroid_y[i], p.centroid_z[i]) +
          patches.t_view_patch,
      patches.R_view_patch * Eigen::Vector3f(p.normal_x[i], p.normal_y[i], p.normal_z[i])};
}

Eigen::Vector2f project(const TileView& view, const Eigen::Vector3f& point) {
  const CameraIntrinsics& k = view.camera;
  if (view.distorted) return projectPoint(k, point.cast<double>()).cast<float>();
  const float inverse_z = 1.0F / point.z();
  return {static_cast<float>(k.fx) * point.x() * inverse_z + static_cast<float>(k.cx),
          static_cast<float>(k.fy) * point.y() * inverse_z + static_cast<float>(k.cy)};
}

/// Nearest whole pixel, whether in the image or not.
bool roundInside(const TileView& view, const Eigen::Vector2f& pixel, int& x, int& y) {
  const float rounded_x = std::floor(pixel.x() + 0.5F);
  const float rounded_y = std::floor(pixel.y() + 0.5F);
  if (!(rounded_x >= 0.0F && rounded_y >= 0.0F &&
        rounded_x < static_cast<float>(view.camera.width) &&
        rounded_y < static_cast<float>(view.camera.height))) {
    return false;
  }
  x = static_cast<int>(rounded_x);
  y = static_cast<int>(rounded_y);
  return true;
}

int tileAt(const TileView& view, const Eigen::Vector2f& pixel) {
  int x = 0;
  int y = 0;
  if (!roundInside(view, pixel, x, y)) return SeenTiles::kNotInView;
  return view.tileAt(x, y);
}

Eigen::Vector3f normalOf(const TileView& view, std::size_t tile) {
  return {view.normal_x[tile], view.normal_y[tile], view.normal_z[tile]};
}

/// The best tile for one patch.
std::int32_t bestTile(const TileView& view, const Moved& patch, const ViewGates& gates) {
  using namespace view_search;
  if (patch.centroid.z() < kNearestDepth || patch.normal.dot(patch.centroid) >= 0.0F) return -1;
  const Eigen::Vector2f pixel = project(view, patch.centroid);
  const float pixels_a_metre = static_cast<float>(view.camera.fx) / patch.centroid.z();
  const float stride =
      std::clamp(kStrideOfGate * gates.distance * pixels_a_metre, kShortestStride, kLongestStride);
  const float gap = stride / pixels_a_metre;
  std::int32_t best = -1;
  float best_cost = kNoCost;
  for (int place = 0; place < kPlaces; ++place) {
    const int tile = tileAt(view, pixel + stride * Eigen::Vector2f(kPlaceX[place], kPlaceY[place]));
    if (tile < 0) continue;
    const Eigen::Vector3f normal = normalOf(view, static_cast<std::size_t>(tile));
    const float cosine = normal.dot(patch.normal);
    const float distance = normal.dot(patch.centroid) + view.d[static_cast<std::size_t>(tile)];
    if (cosine < gates.min_cosine || std::abs(distance) > gates.distance) continue;
    const float cost = distance * distance + (place == 0 ? 0.0F : gap * gap) +
                       gates.squared_normal_length * (2.0F - 2.0F * cosine);
    if (cost >= best_cost) continue;
    best_cost = cost;
    best = tile;
  }
  return best;
}

}  // namespace

void TileView::add(const Eigen::Vector3d& normal, double tile_d) {
  normal_x.push_back(static_cast<float>(normal.x()));
  normal_y.push_back(static_cast<float>(normal.y()));
  normal_z.push_back(static_cast<float>(normal.z()));
  d.push_back(static_cast<float>(tile_d));
}

SeenTiles::SeenTiles(std::size_t count)
    : tiles(count, kNotInView), depth(count), seen_depth(count), cosine(count) {}

std::vector<std::int32_t> bestTilesScalar(const TileView& view, const MovedPatches& patches,
                                          const ViewGates& gates) {
  std::vector<std::int32_t> tiles(patches.count);
  for (std::size_t i = 0; i < patches.count; ++i) {
    tiles[i] = bestTile(view, moved(patches, i), gates);
  }
  return tiles;
}

SeenTiles lookUpTilesScalar(const TileView& view, const MovedPatches& patches) {
  SeenTiles seen(patches.count);
  for (std::size_t i = 0; i < patches.count; ++i) {
    const Moved patch = moved(patches, i);
    const float z = patch.centroid.z();
    if (!(z > 0.0F) || patch.normal.dot(patch.centroid) >= 0.0F) continue;
    seen.tiles[i] = tileAt(view, project(view, patch.centroid));
    if (seen.tiles[i] < 0) continue;
    const std::size_t tile = static_cast<std::size_t>(seen.tiles[i]);
    const Eigen::Vector3f normal = normalOf(view, tile);
    // A grazing plane is met anywhere.
    const float slope = -normal.dot(patch.centroid);
    seen.depth[i] = z;
    seen.seen_depth[i] = slope > 0.0F ? view.d[tile] * z / slope : z;
    seen.cosine[i] = normal.dot(patch.normal);
  }
  return seen;
}

std::vector<std::int32_t> bestTiles(const TileView& view, const MovedPatches& patches,
                                    const ViewGates& gates) {
#ifdef PLANECLOUD_SLAM_HAVE_HIGHWAY
  if (!view.distorted) return bestTilesVector(view, patches, gates);
#endif
  return bestTilesScalar(view, patches, gates);
}

SeenTiles lookUpTiles(const TileView& view, const MovedPatches& patches) {
#ifdef PLANECLOUD_SLAM_HAVE_HIGHWAY
  if (!view.distorted) return lookUpTilesVector(view, patches);
#endif
  return lookUpTilesScalar(view, patches);
}

}  // namespace planecloud
