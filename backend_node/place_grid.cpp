// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/place_grid.h"

#include <algorithm>
#include <cmath>

namespace planecloud {
namespace {

constexpr double kCell = 2.0;      ///< side [m]
constexpr double kFarthest = 1e9;  ///< in cells; nothing real is beyond

}  // namespace

std::size_t PlaceGrid::CellHash::operator()(const Cell& cell) const {
  // Primes after Teschner et al., Optimized Spatial Hashing, 2003.
  return static_cast<std::size_t>(cell[0]) * 73856093U ^
         static_cast<std::size_t>(cell[1]) * 19349663U ^
         static_cast<std::size_t>(cell[2]) * 83492791U;
}

PlaceGrid::Cell PlaceGrid::cellAt(const Eigen::Vector3d& position) {
  Cell cell{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double place = std::floor(position[static_cast<Eigen::Index>(i)] / kCell);
    cell[i] = static_cast<std::int32_t>(std::clamp(place, -kFarthest, kFarthest));
  }
  return cell;
}

void PlaceGrid::place(int node, const Eigen::Vector3d& position) {
  const auto index = static_cast<std::size_t>(node);
  const Cell cell = cellAt(position);
  if (index == cells_.size()) {
    cells_.push_back(cell);
  } else {
    if (cells_.at(index) == cell) return;
    const auto before = nodes_.find(cells_[index]);
    std::vector<int>& nodes = before->second;
    nodes.erase(std::find(nodes.begin(), nodes.end(), node));
    if (nodes.empty()) nodes_.erase(before);
    cells_[index] = cell;
  }
  nodes_[cell].push_back(node);
}

std::vector<int> PlaceGrid::around(const Eigen::Vector3d& centre, double radius) const {
  const Cell low = cellAt(centre - Eigen::Vector3d::Constant(radius));
  const Cell high = cellAt(centre + Eigen::Vector3d::Constant(radius));
  std::vector<int> result;
  for (std::int32_t x = low[0]; x <= high[0]; ++x) {
    for (std::int32_t y = low[1]; y <= high[1]; ++y) {
      for (std::int32_t z = low[2]; z <= high[2]; ++z) {
        const auto found = nodes_.find({x, y, z});
        if (found == nodes_.end()) continue;
        result.insert(result.end(), found->second.begin(), found->second.end());
      }
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace planecloud
