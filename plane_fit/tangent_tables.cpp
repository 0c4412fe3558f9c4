// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tangent_tables.h"

#include <algorithm>
#include <cmath>

#include "planecloud_slam/plane_fit/plane_regression.h"

namespace planecloud {
namespace {

void prepareRegression(const TangentSums& sums, std::size_t node, FullNodes& full) {
  TileMoments moments;
  moments.n = full.n[node];
  moments.u = sums.u;
  moments.v = sums.v;
  moments.uu = sums.uu;
  moments.uv = sums.uv;
  moments.vv = sums.vv;
  const TangentScatterInverse inverse = invertTangentScatter(moments);
  full.inverse_n[node] = 1.0F / full.n[node];
  full.mean_u[node] = sums.u / full.n[node];
  full.mean_v[node] = sums.v / full.n[node];
  full.inverse_uu[node] = static_cast<float>(inverse.uu);
  full.inverse_uv[node] = static_cast<float>(inverse.uv);
  full.inverse_vv[node] = static_cast<float>(inverse.vv);
}

}  // namespace

void FullNodes::resize(std::size_t nodes) {
  for (std::vector<float>* values : {&n, &inverse_n, &mean_u, &mean_v, &reach_u, &reach_v,
                                     &inverse_uu, &inverse_uv, &inverse_vv}) {
    values->resize(nodes, 0.0F);
  }
}

void AffineTangents::resize(std::size_t cells) {
  for (std::vector<float>* values : {&u, &u_right, &u_down, &v, &v_right, &v_down}) {
    values->resize(cells, 0.0F);
  }
}

TangentTables::TangentTables(const Camera& camera, const QuadtreeGrid& grid)
    : u_(camera.width(), camera.height()),
      v_(camera.width(), camera.height()),
      levels_(static_cast<std::size_t>(grid.levels())) {
  for (int i = 0; i < grid.levels(); ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    level.columns = grid.columns(i);
    const auto nodes = static_cast<std::size_t>(grid.columns(i) * grid.rows(i));
    level.full.resize(nodes);
    level.sums.resize(nodes);
  }
  tabulatePixels(camera, grid);
  tabulateCells(grid);
  for (std::size_t parent = levels_.size() - 1; parent-- > 0;) mergeLevel(parent);
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

void TangentTables::tabulateCells(const QuadtreeGrid& grid) {
  Level& cells = levels_.back();
  cells_.resize(cells.sums.size());
  for (std::size_t i = 0; i < cells.sums.size(); ++i) {
    const int index = static_cast<int>(i);
    const TileRect rect =
        grid.rect({grid.levels() - 1, index % cells.columns, index / cells.columns});
    TileMoments sums;
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      for (int x = rect.x; x < rect.x + rect.width; ++x) {
        sums.add(u_(x, y), v_(x, y), 0.0);
      }
    }
    cells.full.n[i] = static_cast<float>(sums.n);
    cells.sums[i] = {static_cast<float>(sums.u), static_cast<float>(sums.v),
                     static_cast<float>(sums.uu), static_cast<float>(sums.uv),
                     static_cast<float>(sums.vv)};
    if (rect.area() > 0) approximateCell(rect, i);
  }
}

void TangentTables::approximateCell(const TileRect& rect, std::size_t cell) {
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
  cells_.u[cell] = u_plane.z();
  cells_.u_right[cell] = rect.width > 1 ? u_plane.x() : 1.0F;
  cells_.u_down[cell] = u_plane.y();
  cells_.v[cell] = v_plane.z();
  cells_.v_right[cell] = v_plane.x();
  cells_.v_down[cell] = rect.height > 1 ? v_plane.y() : 1.0F;
}

void TangentTables::mergeLevel(std::size_t parent_level) {
  Level& parents = levels_[parent_level];
  const Level& children = levels_[parent_level + 1];
  const auto columns = static_cast<std::size_t>(children.columns);
  for (std::size_t i = 0; i < children.sums.size(); ++i) {
    const std::size_t parent =
        i / columns / 2 * static_cast<std::size_t>(parents.columns) + i % columns / 2;
    parents.full.n[parent] += children.full.n[i];
    parents.sums[parent] += children.sums[i];
  }
}

void TangentTables::prepareRegressions(const QuadtreeGrid& grid) {
  for (int i = 0; i + 1 < grid.levels(); ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    for (std::size_t j = 0; j < level.sums.size(); ++j) {
      if (level.full.n[j] == 0.0F) continue;
      prepareRegression(level.sums[j], j, level.full);
      const int index = static_cast<int>(j);
      measureReach(grid.rect({i, index % level.columns, index / level.columns}), j, level.full);
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
