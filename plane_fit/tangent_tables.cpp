// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tangent_tables.h"

#include <algorithm>
#include <cmath>

namespace planecloud {
namespace {

void prepareRegression(const TangentSums& sums, std::size_t node, FullNodes& full) {
  const TangentScatterInverse inverse = invertTangentScatter(tangentMoments(full.n[node], sums));
  full.inverse_n[node] = 1.0F / full.n[node];
  full.mean_u[node] = sums.u / full.n[node];
  full.mean_v[node] = sums.v / full.n[node];
  full.inverse_uu[node] = static_cast<float>(inverse.uu);
  full.inverse_uv[node] = static_cast<float>(inverse.uv);
  full.inverse_vv[node] = static_cast<float>(inverse.vv);
}

QuadtreeNode nodeAt(const QuadtreeGrid& grid, int level, std::size_t i) {
  const int index = static_cast<int>(i);
  return {level, index % grid.columns(level), index / grid.columns(level)};
}

}  // namespace

TileMoments tangentMoments(double n, const TangentSums& sums) {
  TileMoments moments;
  moments.n = n;
  moments.u = sums.u;
  moments.v = sums.v;
  moments.uu = sums.uu;
  moments.uv = sums.uv;
  moments.vv = sums.vv;
  return moments;
}

void FullNodes::resize(std::size_t nodes) {
  for (std::vector<float>* values : {&n, &inverse_n, &mean_u, &mean_v, &reach_u, &reach_v,
                                     &inverse_uu, &inverse_uv, &inverse_vv}) {
    values->resize(nodes, 0.0F);
  }
}

void AffineTangents::resize(std::size_t nodes) {
  for (std::vector<float>* values : {&u, &u_right, &u_down, &v, &v_right, &v_down}) {
    values->resize(nodes, 0.0F);
  }
}

TangentTables::TangentTables(const Camera& camera, const QuadtreeGrid& grid, int finest)
    : u_(camera.width(), camera.height()),
      v_(camera.width(), camera.height()),
      levels_(static_cast<std::size_t>(finest) + 1) {
  for (int i = 0; i <= finest; ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    const auto nodes = static_cast<std::size_t>(grid.columns(i) * grid.rows(i));
    level.full.resize(nodes);
    level.sums.resize(nodes);
  }
  tabulatePixels(camera, grid);
  tabulateFinest(grid);
  for (std::size_t parent = levels_.size() - 1; parent-- > 0;) mergeLevel(parent, grid);
  prepareRegressions(grid);
}

void TangentTables::tabulatePixels(const Camera& camera, const QuadtreeGrid& grid) {
  for (int row = 0; row < grid.rows(0); ++row) {
    for (int column = 0; column < grid.columns(0); ++column) {
      const TileRect root = grid.rect({0, column, row});
      const int center_x = root.x + root.width / 2;
      const int center_y = root.y + root.height / 2;
      const Eigen::Vector2f center(camera.tangentsX()(center_x, center_y),
                                   camera.tangentsY()(center_x, center_y));
      origins_.push_back(center);
      for (int y = root.y; y < root.y + root.height; ++y) {
        for (int x = root.x; x < root.x + root.width; ++x) {
          u_(x, y) = camera.tangentsX()(x, y) - center.x();
          v_(x, y) = camera.tangentsY()(x, y) - center.y();
        }
      }
    }
  }
}

void TangentTables::tabulateFinest(const QuadtreeGrid& grid) {
  const int finest = static_cast<int>(levels_.size()) - 1;
  Level& nodes = levels_.back();
  finest_.resize(nodes.sums.size());
  for (std::size_t i = 0; i < nodes.sums.size(); ++i) {
    const TileRect rect = grid.rect(nodeAt(grid, finest, i));
    TileMoments sums;
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      for (int x = rect.x; x < rect.x + rect.width; ++x) {
        sums.add(u_(x, y), v_(x, y), 0.0);
      }
    }
    nodes.full.n[i] = static_cast<float>(sums.n);
    nodes.sums[i] = {static_cast<float>(sums.u), static_cast<float>(sums.v),
                     static_cast<float>(sums.uu), static_cast<float>(sums.uv),
                     static_cast<float>(sums.vv)};
    if (rect.area() > 0) approximate(rect, i);
  }
}

void TangentTables::approximate(const TileRect& rect, std::size_t node) {
  TileMoments u, v;  // regressions of the tangents on pixel positions
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      u.add(x, y, u_(rect.x + x, rect.y + y));
      v.add(x, y, v_(rect.x + x, rect.y + y));
    }
  }
  const Eigen::Vector3f u_plane = regressInverseDepth(u).cast<float>();
  const Eigen::Vector3f v_plane = regressInverseDepth(v).cast<float>();
  // What is one pixel wide or high has no slope across: any that can be inverted.
  finest_.u[node] = u_plane.z();
  finest_.u_right[node] = rect.width > 1 ? u_plane.x() : 1.0F;
  finest_.u_down[node] = u_plane.y();
  finest_.v[node] = v_plane.z();
  finest_.v_right[node] = v_plane.x();
  finest_.v_down[node] = rect.height > 1 ? v_plane.y() : 1.0F;
}

void TangentTables::mergeLevel(std::size_t parent_level, const QuadtreeGrid& grid) {
  Level& parents = levels_[parent_level];
  const Level& children = levels_[parent_level + 1];
  const auto columns = static_cast<std::size_t>(grid.columns(static_cast<int>(parent_level) + 1));
  for (std::size_t i = 0; i < children.sums.size(); ++i) {
    const std::size_t parent = i / columns / 2 * (columns / 2) + i % columns / 2;
    parents.full.n[parent] += children.full.n[i];
    parents.sums[parent] += children.sums[i];
  }
}

void TangentTables::prepareRegressions(const QuadtreeGrid& grid) {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    for (std::size_t j = 0; j < level.sums.size(); ++j) {
      if (level.full.n[j] == 0.0F) continue;
      prepareRegression(level.sums[j], j, level.full);
      measureReach(grid.rect(nodeAt(grid, static_cast<int>(i), j)), j, level.full);
    }
  }
}

void TangentTables::measureReach(const TileRect& rect, std::size_t node, FullNodes& full) const {
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      const Eigen::Vector2f tangents = at(x, y);
      full.reach_u[node] = std::max(full.reach_u[node], std::abs(tangents.x() - full.mean_u[node]));
      full.reach_v[node] = std::max(full.reach_v[node], std::abs(tangents.y() - full.mean_v[node]));
    }
  }
}

}  // namespace planecloud
