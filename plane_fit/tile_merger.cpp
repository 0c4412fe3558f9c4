// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_merger.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace planecloud {
namespace {

/// What a covered pixel is worth [1/m^2]: as much as an error of 0.1 1/m, 10 cm at 1 m, costs.
constexpr double kPixelWorth = 1e-2;
constexpr double kLowestPrice = 1e-7;               // [1/m^2 a bit]
constexpr double kPriceRatio = 1.0905077326652577;  // eight to a doubling
/// Bits of a merged tile over those of the tiles that came: larger ones are coded finer.
constexpr double kMergedShare = 1.5;
constexpr double kBranchBits = 1.0;
constexpr double kMeanPerRms = 0.798;  // of a normal distribution
/// Merged planes have at least this inverse depth all over their tile [1/m].
constexpr double kNearestPlane = 1.0 / 64.0;

double inverseDepthAt(const PlanarTile& tile, const Eigen::Vector2d& tangents) {
  return tile.inverse_depth.cast<double>().dot(tangents.homogeneous());
}

/// Moments of a plane over the pixels of its tile: four points have the first and second moments
/// of all of them. None where the lens model cannot be inverted.
std::optional<TileMoments> momentsOf(const PlanarTile& tile, const CameraIntrinsics& camera) {
  const TileRect& rect = tile.rect;
  const double x = rect.x + 0.5 * (rect.width - 1);
  const double y = rect.y + 0.5 * (rect.height - 1);
  const double dx = std::sqrt((rect.width * rect.width - 1) / 12.0);
  const double dy = std::sqrt((rect.height * rect.height - 1) / 12.0);
  TileMoments moments;
  for (const auto& [side_x, side_y] : {std::pair(-1, -1), {1, -1}, {-1, 1}, {1, 1}}) {
    const auto tangents = tangentsAt(camera, x + side_x * dx, y + side_y * dy);
    if (!tangents) return std::nullopt;
    moments.add(tangents->x(), tangents->y(), inverseDepthAt(tile, *tangents), 0.25 * rect.area());
  }
  return moments;
}

bool liesInFront(const PlanarTile& tile, const CameraIntrinsics& camera) {
  const TileRect& rect = tile.rect;
  for (const int x : {rect.x, rect.x + rect.width - 1}) {
    for (const int y : {rect.y, rect.y + rect.height - 1}) {
      const auto tangents = tangentsAt(camera, x, y);
      if (!tangents || inverseDepthAt(tile, *tangents) < kNearestPlane) return false;
    }
  }
  return true;
}

/// Squared residuals of the regression on `m`.
double squaredResiduals(const TileMoments& m, const Eigen::Vector3d& plane) {
  return std::max(0.0, m.qq - plane.dot(Eigen::Vector3d(m.qu, m.qv, m.q)));
}

}  // namespace

TileMerger::TileMerger(const QuadtreeGrid& grid, const CameraIntrinsics& camera,
                       const std::vector<TileNode>& tiles, const std::vector<double>& bits)
    : grid_(grid),
      camera_(camera),
      merged_bits_(kMergedShare * std::accumulate(bits.begin(), bits.end(), 0.0) /
                   static_cast<double>(std::max<std::size_t>(1, bits.size()))) {
  std::vector<std::int32_t> nodes, parents;
  auto next = tiles.rbegin();  // the finest come last
  for (int level = grid.levels() - 1; level >= 0; --level, nodes.swap(parents)) {
    nodes.resize(index({level, 0, grid.rows(level)}), kNone);
    for (; next != tiles.rend() && next->node.level == level; ++next) {
      nodes[index(next->node)] = static_cast<std::int32_t>(regions_.size());
      Region& region = regions_.emplace_back();
      region.tile = next->tile;
      region.bits = bits[static_cast<std::size_t>(tiles.rend() - next) - 1];
      region.moments = momentsOf(next->tile, camera).value_or(TileMoments());
    }
    parents.clear();
    if (level > 0) mergeChildren(level, nodes, parents);
  }
}

void TileMerger::mergeChildren(int level, const std::vector<std::int32_t>& nodes,
                               std::vector<std::int32_t>& parents) {
  parents.assign(index({level - 1, 0, grid_.rows(level - 1)}), kNone);
  for (int row = 0; row < grid_.rows(level - 1); ++row) {
    for (int column = 0; column < grid_.columns(level - 1); ++column) {
      const QuadtreeNode parent{level - 1, column, row};
      std::optional<Region> region = collectChildren(parent, nodes);
      if (!region || !merge(*region)) continue;
      for (const std::int32_t child : region->children) {
        if (child != kNone) regions_[static_cast<std::size_t>(child)].has_parent = true;
      }
      parents[index(parent)] = static_cast<std::int32_t>(regions_.size());
      regions_.push_back(*region);
    }
  }
}

std::optional<TileMerger::Region> TileMerger::collectChildren(
    const QuadtreeNode& parent, const std::vector<std::int32_t>& nodes) const {
  Region region;
  region.tile.rect = grid_.rect(parent);
  std::size_t children = 0;
  for (const int row : {2 * parent.row, 2 * parent.row + 1}) {
    for (const int column : {2 * parent.column, 2 * parent.column + 1}) {
      const QuadtreeNode child{parent.level + 1, column, row};
      const std::int32_t i = nodes[index(child)];
      if (i != kNone) {
        region.children[children++] = i;
      } else if (grid_.rect(child).area() > 0) {
        return std::nullopt;
      }
    }
  }
  if (children < 2) return std::nullopt;  // beyond the border, or the same pixels as the child
  return region;
}

bool TileMerger::merge(Region& region) const {
  for (const std::int32_t child : region.children) {
    if (child == kNone) continue;
    const TileMoments& moments = regions_[static_cast<std::size_t>(child)].moments;
    if (moments.n == 0.0) return false;
    region.moments += moments;
  }
  const Eigen::Vector3d plane = regressInverseDepth(region.moments);
  region.tile.inverse_depth = plane.cast<float>();
  region.distortion = squaredResiduals(region.moments, plane);
  region.bits = merged_bits_;
  region.is_merged = true;
  return liesInFront(region.tile, camera_);
}

std::vector<TileMerger::Verdict> TileMerger::weigh(int step) const {
  std::vector<Verdict> verdicts(regions_.size());
  if (step >= kPrices) return verdicts;
  const double price = step == 0 ? 0.0 : kLowestPrice * std::pow(kPriceRatio, step - 1);
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const Region& region = regions_[i];
    Verdict& verdict = verdicts[i];
    verdict.cost = region.distortion + price * region.bits;
    if (region.is_merged) {
      double apart = price * kBranchBits;
      for (const std::int32_t child : region.children) {
        if (child != kNone) apart += verdicts[static_cast<std::size_t>(child)].cost;
      }
      verdict.is_split = apart <= verdict.cost;
      verdict.cost = std::min(verdict.cost, apart);
    }
    verdict.is_wanted = !region.has_parent && verdict.cost <= kPixelWorth * region.tile.rect.area();
  }
  return verdicts;
}

std::vector<std::size_t> TileMerger::regionsBelow(const std::vector<Verdict>& verdicts,
                                                  const std::vector<Verdict>& lower) const {
  std::vector<std::size_t> regions;
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    if (lower[i].is_wanted && !verdicts[i].is_wanted) regions.push_back(i);
  }
  const auto flatness = [&](std::size_t i) { return lower[i].cost / regions_[i].tile.rect.area(); };
  std::stable_sort(regions.begin(), regions.end(),
                   [&](std::size_t a, std::size_t b) { return flatness(a) < flatness(b); });
  return regions;
}

void TileMerger::collect(std::vector<Verdict> verdicts, Version& version) const {
  for (std::size_t i = regions_.size(); i-- > 0;) {  // parents before children
    const Region& region = regions_[i];
    if (!verdicts[i].is_wanted) continue;
    if (verdicts[i].is_split) {
      for (const std::int32_t child : region.children) {
        if (child != kNone) verdicts[static_cast<std::size_t>(child)].is_wanted = true;
      }
      continue;
    }
    version.tiles.push_back(region.tile);
    version.pixels += region.moments.n;
    version.inverse_depth += region.moments.q;
    version.distortion += region.distortion;
  }
}

TileMerger::Version TileMerger::at(int price) const {
  Version version;
  collect(weigh(price), version);
  return version;
}

TileMerger::Version TileMerger::largest(const std::function<bool(const Version&)>& fits) const {
  int refused = 0;
  int accepted = kPrices;
  while (accepted - refused > 1) {
    const int middle = (refused + accepted) / 2;
    (fits(at(middle)) ? accepted : refused) = middle;
  }
  const Version cheapest = at(accepted);
  std::vector<Verdict> lower = weigh(accepted - 1);
  const std::vector<std::size_t> extra = regionsBelow(weigh(accepted), lower);
  for (Verdict& verdict : lower) verdict.is_wanted = false;
  const auto with = [&](std::size_t count) {
    Version version = cheapest;
    std::vector<Verdict> verdicts = lower;
    for (std::size_t i = 0; i < count; ++i) verdicts[extra[i]].is_wanted = true;
    collect(std::move(verdicts), version);
    return version;
  };
  std::size_t fitting = 0;
  std::size_t too_many = extra.size() + 1;
  while (too_many - fitting > 1) {
    const std::size_t middle = (fitting + too_many) / 2;
    (fits(with(middle)) ? fitting : too_many) = middle;
  }
  return with(fitting);
}

PlaneCloudStatistics TileMerger::reduce(PlaneCloudStatistics statistics,
                                        const Version& version) const {
  const Version whole = at(0);
  statistics.stopped_by_bytes = true;
  if (version.tiles.empty() || whole.pixels == 0.0) {
    statistics.coverage = statistics.depth_error = statistics.point_plane_error = 0.0;
    return statistics;
  }
  statistics.coverage *= version.pixels / whole.pixels;
  // Merging errs independently of the sensor; both are means of what is about normal.
  const double depth = version.pixels / version.inverse_depth;
  const double added = kMeanPerRms * std::sqrt(version.distortion / version.pixels) * depth * depth;
  const double error = std::hypot(statistics.depth_error, added);
  // The angle between ray and plane is about what it was.
  const double slant =
      statistics.depth_error > 0.0 ? statistics.point_plane_error / statistics.depth_error : 1.0;
  statistics.depth_error = error;
  statistics.point_plane_error = slant * error;
  return statistics;
}

}  // namespace planecloud
