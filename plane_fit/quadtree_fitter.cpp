// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "planecloud_slam/plane_fit/moment_pyramid.h"
#include "planecloud_slam/plane_fit/tile_fitter.h"
#include "planecloud_slam/plane_fit/tree_pruner.h"

namespace planecloud {
namespace {

/// Tiles between two looks at the clock.
constexpr int kTilesAtOnce = 16;
/// Merging cells upwards takes this of the time for reading them, at most.
constexpr double kMergeShare = 0.25;
/// The way from the nodes weighed to tiles takes this of the time for weighing them, at most.
constexpr double kAfterChoiceShare = 0.9;
/// A look at the tiles' pixels takes this of the time for choosing and making them, at most.
constexpr double kLookShare = 0.3;
/// About so many tiles' pixels are looked at to know the errors of all.
constexpr double kLookedAtTiles = 128.0;

template <typename Pixel>
void checkSize(const ImageView<Pixel>& depth, const Camera& camera) {
  if (depth.width() == camera.width() && depth.height() == camera.height()) return;
  throw std::invalid_argument(
      "depth image is " + std::to_string(depth.width()) + "x" + std::to_string(depth.height()) +
      ", its camera " + std::to_string(camera.width()) + "x" + std::to_string(camera.height()) +
      ": use the camera info that belongs to the depth image");
}

/// Keeps an eye on a `FitBudget`.
class BudgetMeter {
 public:
  explicit BudgetMeter(const FitBudget& budget) : budget_(budget) {
    if (budget.deadline && !budget.now) {
      throw std::invalid_argument("a fit deadline needs a clock: set FitBudget::now");
    }
    if (budget.now) start_ = budget.now();
    if (budget.bytes) {
      max_planes_ = static_cast<double>(*budget.bytes) / budget.bytes_per_plane;
    }
  }
  [[nodiscard]] bool timeIsUp() const {
    return budget_.deadline && budget_.now() >= *budget_.deadline;
  }
  /// Now, or never where there is no deadline.
  [[nodiscard]] FitBudget::Clock::time_point now() const {
    return budget_.deadline ? budget_.now() : FitBudget::Clock::time_point::max();
  }
  /// Too late for work that takes `share` of the time since `start`.
  [[nodiscard]] bool timeIsUpForWork(FitBudget::Clock::time_point start, double share) const {
    if (!budget_.deadline) return false;
    const std::chrono::duration<double> now = budget_.now().time_since_epoch();
    const std::chrono::duration<double> since = now - start.time_since_epoch();
    return now + share * since >= budget_.deadline->time_since_epoch();
  }
  [[nodiscard]] bool hasRoomFor(std::size_t planes) const {
    return !budget_.bytes || static_cast<double>(planes) <= max_planes_;
  }
  /// [s], 0 without a clock.
  [[nodiscard]] double elapsed() const {
    if (!budget_.now) return 0.0;
    return std::chrono::duration<double>(budget_.now() - start_).count();
  }

 private:
  const FitBudget& budget_;
  FitBudget::Clock::time_point start_{};
  double max_planes_ = 0.0;
};

}  // namespace

class QuadtreeFitter::Impl {
 public:
  Impl(std::shared_ptr<const Camera> camera, const QuadtreeFitterOptions& options)
      : camera_(std::move(camera)),
        options_(options),
        pyramid_(camera_, layout(options), vectorTileKernels(),
                 TileFitter::distortionRule(options)),
        tile_fitter_(pyramid_, options),
        pruner_(pyramid_, tile_fitter_, options.lambda) {}

  template <typename Pixel>
  PlaneCloud fit(ImageView<Pixel> depth, const FitBudget& budget);

  [[nodiscard]] const QuadtreeFitterOptions& options() const { return options_; }
  [[nodiscard]] const Camera& camera() const { return *camera_; }

 private:
  static QuadtreeLayout layout(const QuadtreeFitterOptions& options) {
    options.check();
    return {options.initial_tile_width, options.initial_tile_height, options.min_tile};
  }
  void fitLevels(const BudgetMeter& meter, PlaneCloudStatistics& statistics);
  void fitPruned(const BudgetMeter& meter, PlaneCloudStatistics& statistics);
  /// Makes the expected errors of `fits_`, of nodes from the first on, those of pixels.
  void lookAtPixels(const std::vector<QuadtreeNode>& nodes);
  void pushRoots();
  void pushChildren(const QuadtreeNode& node);
  void accept(const QuadtreeNode& node, const TileFit& fit);
  [[nodiscard]] double countValidPixels() const;

  std::shared_ptr<const Camera> camera_;
  QuadtreeFitterOptions options_;
  MomentPyramid pyramid_;
  TileFitter tile_fitter_;
  TreePruner pruner_;
  std::vector<QuadtreeNode> queue_;  // the level being fitted
  std::vector<QuadtreeNode> next_;   // the level below
  std::vector<TileFit> fits_;
  std::vector<PlanarTile> tiles_;
  double covered_ = 0.0;
  double depth_sum_ = 0.0;
  double point_plane_sum_ = 0.0;
};

template <typename Pixel>
PlaneCloud QuadtreeFitter::Impl::fit(ImageView<Pixel> depth, const FitBudget& budget) {
  checkSize(depth, *camera_);
  const BudgetMeter meter(budget);
  PlaneCloud cloud;
  cloud.camera = camera_->intrinsics();
  cloud.layout = layout(options_);
  tiles_.clear();
  covered_ = depth_sum_ = point_plane_sum_ = 0.0;
  PlaneCloudStatistics& statistics = cloud.statistics;
  const FitBudget::Clock::time_point start = meter.now();
  const auto is_late = [&] { return meter.timeIsUpForWork(start, kMergeShare); };
  statistics.stopped_by_time =
      !pyramid_.read(depth, budget.deadline ? std::function<bool()>(is_late) : nullptr);
  if (!statistics.stopped_by_time) {
    if (options_.lambda > 0.0) {
      fitPruned(meter, statistics);
    } else {
      fitLevels(meter, statistics);
    }
    statistics.coverage = covered_ / std::max(1.0, countValidPixels());
    statistics.depth_error = depth_sum_ / std::max(1.0, covered_);
    statistics.point_plane_error = point_plane_sum_ / std::max(1.0, covered_);
  }
  cloud.tiles = tiles_;
  statistics.fit_time = meter.elapsed();
  return cloud;
}

void QuadtreeFitter::Impl::fitLevels(const BudgetMeter& meter, PlaneCloudStatistics& statistics) {
  pushRoots();
  int until_look = 0;
  while (!queue_.empty()) {
    next_.clear();
    for (const QuadtreeNode& node : queue_) {
      if (--until_look < 0) {
        statistics.stopped_by_time = meter.timeIsUp();
        if (statistics.stopped_by_time) return;
        until_look = kTilesAtOnce;
      }
      const std::optional<TileFit> fit = tile_fitter_.fit(node);
      if (!fit) {
        pushChildren(node);
        continue;
      }
      statistics.stopped_by_bytes = !meter.hasRoomFor(tiles_.size() + 1);
      if (statistics.stopped_by_bytes) return;
      accept(node, *fit);
    }
    queue_.swap(next_);
  }
}

void QuadtreeFitter::Impl::fitPruned(const BudgetMeter& meter, PlaneCloudStatistics& statistics) {
  bool late = false;
  const FitBudget::Clock::time_point start = meter.now();
  const auto is_late = [&] {
    return late = late || meter.timeIsUpForWork(start, kAfterChoiceShare);
  };
  const std::vector<QuadtreeNode>& nodes = pruner_.choose(is_late);
  statistics.stopped_by_time = late;
  fits_.clear();
  for (const QuadtreeNode& node : nodes) {
    statistics.stopped_by_bytes = !meter.hasRoomFor(tiles_.size() + 1);
    if (statistics.stopped_by_bytes) break;
    fits_.push_back(tile_fitter_.estimate(node));
    accept(node, fits_.back());
  }
  if (!late && !meter.timeIsUpForWork(start, kLookShare)) {
    lookAtPixels(nodes);
    return;
  }
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    point_plane_sum_ += tile_fitter_.estimatePointPlane(nodes[i], fits_[i]);
  }
}

void QuadtreeFitter::Impl::lookAtPixels(const std::vector<QuadtreeNode>& nodes) {
  // Systematic sampling, each tile with a probability that grows with the error it is expected to
  // have; then the ratio of what is found to what was expected, of these tiles, holds for all.
  const double step = depth_sum_ / kLookedAtTiles;
  double since_last = 0.5 * step;
  double expected = 0.0;
  double depth_found = 0.0;
  double point_plane_found = 0.0;
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    since_last += fits_[i].depth_sum;
    if (since_last < step) continue;
    since_last = std::fmod(since_last, step);
    const double weight = std::max(1.0, step / fits_[i].depth_sum);
    const TileFit found = tile_fitter_.sample(nodes[i], fits_[i].plane);
    expected += weight * fits_[i].depth_sum;
    depth_found += weight * found.depth_sum;
    point_plane_found += weight * found.point_plane_sum;
  }
  if (expected <= 0.0) return;
  point_plane_sum_ = depth_sum_ * (point_plane_found / expected);
  depth_sum_ *= depth_found / expected;
}

void QuadtreeFitter::Impl::pushRoots() {
  queue_.clear();
  for (int row = 0; row < pyramid_.grid().rows(0); ++row) {
    for (int column = 0; column < pyramid_.grid().columns(0); ++column) {
      queue_.push_back({0, column, row});
    }
  }
}

void QuadtreeFitter::Impl::pushChildren(const QuadtreeNode& node) {
  if (node.level + 1 == pyramid_.grid().levels()) return;
  pyramid_.split(node);
  for (const int row : {2 * node.row, 2 * node.row + 1}) {
    for (const int column : {2 * node.column, 2 * node.column + 1}) {
      const QuadtreeNode child{node.level + 1, column, row};
      if (pyramid_.count(child) > 0) next_.push_back(child);
    }
  }
}

void QuadtreeFitter::Impl::accept(const QuadtreeNode& node, const TileFit& fit) {
  const Eigen::Vector2d origin = pyramid_.origin(node).cast<double>();
  const Eigen::Vector3d plane = fit.plane.cast<double>();
  PlanarTile tile;
  tile.rect = pyramid_.grid().rect(node);
  tile.inverse_depth << fit.plane.head<2>(),
      static_cast<float>(plane.z() - plane.head<2>().dot(origin));
  tiles_.push_back(tile);
  covered_ += fit.count;
  depth_sum_ += fit.depth_sum;
  point_plane_sum_ += fit.point_plane_sum;
}

double QuadtreeFitter::Impl::countValidPixels() const {
  double count = 0.0;
  for (int row = 0; row < pyramid_.grid().rows(0); ++row) {
    for (int column = 0; column < pyramid_.grid().columns(0); ++column) {
      count += pyramid_.count({0, column, row});
    }
  }
  return count;
}

QuadtreeFitter::QuadtreeFitter(std::shared_ptr<const Camera> camera,
                               const QuadtreeFitterOptions& options)
    : impl_(std::make_unique<Impl>(std::move(camera), options)) {}
QuadtreeFitter::~QuadtreeFitter() = default;
QuadtreeFitter::QuadtreeFitter(QuadtreeFitter&&) noexcept = default;
QuadtreeFitter& QuadtreeFitter::operator=(QuadtreeFitter&&) noexcept = default;

PlaneCloud QuadtreeFitter::fit(ImageView<float> depth, const FitBudget& budget) {
  return impl_->fit(depth, budget);
}

PlaneCloud QuadtreeFitter::fit(ImageView<std::uint16_t> depth, const FitBudget& budget) {
  return impl_->fit(depth, budget);
}

const QuadtreeFitterOptions& QuadtreeFitter::options() const { return impl_->options(); }
const Camera& QuadtreeFitter::camera() const { return impl_->camera(); }

}  // namespace planecloud
