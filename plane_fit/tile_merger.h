// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "planecloud_slam/plane_fit/coding_order.h"
#include "planecloud_slam/plane_fit/plane_regression.h"

namespace planecloud {

/// Coarser versions of a plane cloud, for byte budgets. The tiles that fill a node may become one:
/// the regression of their planes, at the distortion that this adds (squared inverse depth, summed
/// over the pixels; exact, since residuals are orthogonal to a regression). A region that can be
/// one tile is pruned to the least distortion + price * bits, and left out when even that exceeds
/// the worth of its pixels. So whatever is covered at one price is covered at every lower one.
class TileMerger {
 public:
  /// `tiles` in coding order and the bits each of them takes; keeps a reference to `grid`.
  TileMerger(const QuadtreeGrid& grid, const CameraIntrinsics& camera,
             const std::vector<TileNode>& tiles, const std::vector<double>& bits);

  static constexpr int kPrices = 256;
  struct Version {
    std::vector<PlanarTile> tiles;
    double pixels = 0.0;
    double inverse_depth = 0.0;  ///< summed over the pixels [1/m]
    double distortion = 0.0;     ///< added by merging, summed over the pixels [1/m^2]
  };
  /// The cloud at price [0, kPrices] of a bit, ascending: empty at the last.
  [[nodiscard]] Version at(int price) const;

  /// The largest version that `fits`, by bisection: never gets smaller when more fits. Beside what
  /// its price covers it has some of what only the next lower price does, the flattest first.
  [[nodiscard]] Version largest(const std::function<bool(const Version&)>& fits) const;
  /// `statistics` of the whole cloud made those of `version`.
  [[nodiscard]] PlaneCloudStatistics reduce(PlaneCloudStatistics statistics,
                                            const Version& version) const;

 private:
  static constexpr std::int32_t kNone = -1;
  /// A node of the tree that tiles fill without gaps.
  struct Region {
    PlanarTile tile;  // the only one, or all of them merged
    TileMoments moments;
    double distortion = 0.0;  // of `tile`
    double bits = 0.0;
    std::array<std::int32_t, 4> children{kNone, kNone, kNone, kNone};
    bool is_merged = false;
    bool has_parent = false;
  };

  /// What becomes of a region at a price.
  struct Verdict {
    double cost = 0.0;
    bool is_split = false;   // else one tile
    bool is_wanted = false;  // worth its cost
  };

  void mergeChildren(int level, const std::vector<std::int32_t>& nodes,
                     std::vector<std::int32_t>& parents);
  /// The region of `parent` with its children; none unless they fill it.
  [[nodiscard]] std::optional<Region> collectChildren(const QuadtreeNode& parent,
                                                      const std::vector<std::int32_t>& nodes) const;
  /// Makes `region` one tile; false when that is not in front of the camera.
  [[nodiscard]] bool merge(Region& region) const;
  /// Verdicts on all regions at a price [0, kPrices); those that fill no other are wanted or not.
  [[nodiscard]] std::vector<Verdict> weigh(int price) const;
  /// Outermost regions wanted by `lower` alone, the verdicts at a lower price, the flattest first.
  [[nodiscard]] std::vector<std::size_t> regionsBelow(const std::vector<Verdict>& verdicts,
                                                      const std::vector<Verdict>& lower) const;
  /// Adds the tiles of wanted regions.
  void collect(std::vector<Verdict> verdicts, Version& version) const;
  [[nodiscard]] std::size_t index(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(node.row) *
               static_cast<std::size_t>(grid_.columns(node.level)) +
           static_cast<std::size_t>(node.column);
  }

  const QuadtreeGrid& grid_;
  CameraIntrinsics camera_;
  double merged_bits_;           // of a merged tile
  std::vector<Region> regions_;  // children before parents
};

}  // namespace planecloud
