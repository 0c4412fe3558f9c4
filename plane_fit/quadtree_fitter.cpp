// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "planecloud_slam/plane_fit/moment_pyramid.h"

namespace planecloud_slam {
namespace {

/// Planes are only kept where their depth is below this inside the tile [1/m]: 64 m.
constexpr float kMinInverseDepth = 1.0F / 64.0F;
/// Rows of a tile whose error is summed before the tile can be given up.
constexpr int kRowsAtOnce = 16;
/// Tiles between two looks at the clock.
constexpr int kTilesAtOnce = 16;

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

/// A pixel with depth: tangents about the tile's origin, inverse depth.
struct Corner {
  float u = 0.0F;
  float v = 0.0F;
  float q = 0.0F;
};
using Corners = std::array<Corner, 4>;  // upper left, upper right, lower left, lower right

/// A plane of inverse depth in the tangents about `origin`, and how well it fits.
struct TileFit {
  Eigen::Vector3f plane;
  double count = 0.0;
  double depth_sum = 0.0;        // sum of |z - z^| [m]
  double point_plane_sum = 0.0;  // [m]
};

}  // namespace

std::string toString(AcceptanceRule rule) {
  switch (rule) {
    case AcceptanceRule::kFixed:
      return "fixed";
    case AcceptanceRule::kLinearInDepth:
      return "linear_in_depth";
    case AcceptanceRule::kNoiseScaled:
      break;
  }
  return "noise_scaled";
}

void fromString(const std::string& text, AcceptanceRule& rule) {
  for (const AcceptanceRule candidate :
       {AcceptanceRule::kFixed, AcceptanceRule::kLinearInDepth, AcceptanceRule::kNoiseScaled}) {
    if (text != toString(candidate)) continue;
    rule = candidate;
    return;
  }
  throw std::invalid_argument("acceptance '" + text +
                              "': must be fixed, linear_in_depth or noise_scaled");
}

std::string toString(CornerCheck check) {
  switch (check) {
    case CornerCheck::kNone:
      return "none";
    case CornerCheck::kWindow:
      return "window";
    case CornerCheck::kExact:
      break;
  }
  return "exact";
}

void fromString(const std::string& text, CornerCheck& check) {
  for (const CornerCheck candidate :
       {CornerCheck::kNone, CornerCheck::kWindow, CornerCheck::kExact}) {
    if (text != toString(candidate)) continue;
    check = candidate;
    return;
  }
  throw std::invalid_argument("corner_check '" + text + "': must be none, window or exact");
}

void QuadtreeFitterOptions::check() const {
  checkRange("plane_fit/initial_tile_width", initial_tile_width, 2, 80);
  checkRange("plane_fit/initial_tile_height", initial_tile_height, 2, 80);
  checkRange("plane_fit/min_tile", min_tile, 2,
             std::min({initial_tile_width, initial_tile_height, 64}));
  checkRange("plane_fit/tolerance", tolerance, 1e-5, 1.0);
  checkRange("plane_fit/min_fill", min_fill, 0.0, 1.0);
  checkRange("plane_fit/planarity_factor", planarity_factor, 0.0, 1000.0);
  checkRange("plane_fit/time_budget", time_budget, 0.0, 10.0);
  checkRange("plane_fit/byte_budget", byte_budget, 0, 1 << 30);
}

class QuadtreeFitter::Impl {
 public:
  Impl(std::shared_ptr<const Camera> camera, const QuadtreeFitterOptions& options)
      : camera_(std::move(camera)),
        options_(options),
        pyramid_(camera_, layout(options), vectorTileKernels()) {}

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
  [[nodiscard]] std::optional<TileFit> fitTile(const QuadtreeNode& node) const;
  [[nodiscard]] std::optional<Corners> findCorners(const TileRect& rect) const;
  [[nodiscard]] Corner findCorner(int x, int y, int step_x, int step_y, int window) const;
  [[nodiscard]] bool isPlanar(const Corners& corners, const Eigen::Vector2f& origin,
                              float allowed) const;
  [[nodiscard]] bool isInFront(const TileRect& rect, const Eigen::Vector3f& plane) const;
  [[nodiscard]] std::optional<TileFit> measure(const TileRect& rect, const Eigen::Vector3f& plane,
                                               const Eigen::Vector2f& origin, double count,
                                               float mean_depth) const;
  [[nodiscard]] float allowedError(float depth) const;
  void pushRoots();
  void pushChildren(const QuadtreeNode& node);
  void accept(const QuadtreeNode& node, const TileFit& fit);
  [[nodiscard]] double countValidPixels() const;

  std::shared_ptr<const Camera> camera_;
  QuadtreeFitterOptions options_;
  MomentPyramid pyramid_;
  std::vector<QuadtreeNode> queue_;  // the level being fitted
  std::vector<QuadtreeNode> next_;   // the level below
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
  statistics.stopped_by_time = !pyramid_.read(
      depth, budget.deadline ? std::function<bool()>([&] { return meter.timeIsUp(); }) : nullptr);
  if (!statistics.stopped_by_time) {
    fitLevels(meter, statistics);
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
      const std::optional<TileFit> fit = fitTile(node);
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

std::optional<TileFit> QuadtreeFitter::Impl::fitTile(const QuadtreeNode& node) const {
  const int count = pyramid_.count(node);
  if (count == 0 || count < options_.min_fill * pyramid_.area(node)) return std::nullopt;
  const TileRect rect = pyramid_.grid().rect(node);
  const Eigen::Vector2f origin = pyramid_.origin(node).cast<float>();
  const float mean_depth = 1.0F / pyramid_.meanInverseDepth(node);
  if (options_.corner_check != CornerCheck::kNone) {
    const std::optional<Corners> corners = findCorners(rect);
    if (!corners || !isPlanar(*corners, origin, allowedError(mean_depth))) return std::nullopt;
  }
  const Eigen::Vector3f plane = pyramid_.regress(node).cast<float>();
  if (!isInFront(rect, plane)) return std::nullopt;
  return measure(rect, plane, origin, count, mean_depth);
}

std::optional<Corners> QuadtreeFitter::Impl::findCorners(const TileRect& rect) const {
  const bool exact = options_.corner_check == CornerCheck::kExact;
  const int window = exact ? 1 : std::min(4, (std::min(rect.width, rect.height) + 1) / 2);
  const int right = rect.x + rect.width - 1;
  const int bottom = rect.y + rect.height - 1;
  Corners corners;
  corners[0] = findCorner(rect.x, rect.y, 1, 1, window);
  corners[1] = findCorner(right, rect.y, -1, 1, window);
  corners[2] = findCorner(rect.x, bottom, 1, -1, window);
  corners[3] = findCorner(right, bottom, -1, -1, window);
  for (const Corner& corner : corners) {
    if (corner.q == 0.0F) return std::nullopt;
  }
  return corners;
}

Corner QuadtreeFitter::Impl::findCorner(int x, int y, int step_x, int step_y, int window) const {
  // Diagonals outwards from the corner: the nearest valid pixel comes first.
  for (int ring = 0; ring <= 2 * (window - 1); ++ring) {
    for (int i = std::max(0, ring - window + 1); i <= std::min(ring, window - 1); ++i) {
      const int px = x + i * step_x;
      const int py = y + (ring - i) * step_y;
      const float q = pyramid_.inverseDepth(px, py);
      if (q == 0.0F) continue;
      const Eigen::Vector2f tangents = pyramid_.tangents(px, py);
      return {tangents.x(), tangents.y(), q};
    }
  }
  return {};
}

bool QuadtreeFitter::Impl::isPlanar(const Corners& c, const Eigen::Vector2f& origin,
                                    float allowed) const {
  if (options_.planarity_factor == 0.0) return true;
  const float u1 = c[1].u - c[0].u, v1 = c[1].v - c[0].v, q1 = c[1].q - c[0].q;
  const float u2 = c[2].u - c[0].u, v2 = c[2].v - c[0].v, q2 = c[2].q - c[0].q;
  const float det = u1 * v2 - u2 * v1;
  if (det == 0.0F) return true;  // a single row or column has no fourth corner
  const float alpha = (q1 * v2 - q2 * v1) / det;
  const float beta = (u1 * q2 - u2 * q1) / det;
  const float fourth = c[0].q + alpha * (c[3].u - c[0].u) + beta * (c[3].v - c[0].v);
  const float gamma = c[0].q - alpha * (c[0].u + origin.x()) - beta * (c[0].v + origin.y());
  const float norm = std::sqrt(alpha * alpha + beta * beta + gamma * gamma);
  const float distance = std::abs(c[3].q - fourth) / (c[3].q * norm);
  return distance <= static_cast<float>(options_.planarity_factor) * allowed;
}

bool QuadtreeFitter::Impl::isInFront(const TileRect& rect, const Eigen::Vector3f& plane) const {
  const int right = rect.x + rect.width - 1;
  const int bottom = rect.y + rect.height - 1;
  float nearest = std::numeric_limits<float>::infinity();
  for (const int y : {rect.y, bottom}) {
    for (const int x : {rect.x, right}) {
      nearest = std::min(nearest, plane.head<2>().dot(pyramid_.tangents(x, y)) + plane.z());
    }
  }
  return nearest >= kMinInverseDepth;
}

float QuadtreeFitter::Impl::allowedError(float depth) const {
  const auto tolerance = static_cast<float>(options_.tolerance);
  switch (options_.acceptance) {
    case AcceptanceRule::kFixed:
      return tolerance;
    case AcceptanceRule::kLinearInDepth:
      return tolerance * depth;
    case AcceptanceRule::kNoiseScaled:
      break;
  }
  return tolerance * depth * depth;
}

std::optional<TileFit> QuadtreeFitter::Impl::measure(const TileRect& rect,
                                                     const Eigen::Vector3f& plane,
                                                     const Eigen::Vector2f& origin, double count,
                                                     float mean_depth) const {
  const double d =
      1.0 / Eigen::Vector3f(plane.x(), plane.y(), plane.z() - plane.head<2>().dot(origin)).norm();
  const double allowed_sum = count * allowedError(mean_depth);
  const bool noise_scaled = options_.acceptance == AcceptanceRule::kNoiseScaled;
  TileFit fit;
  fit.plane = plane;
  fit.count = count;
  double inverse_depth_sum = 0.0;
  for (int y = 0; y < rect.height; y += kRowsAtOnce) {
    const ResidualSums sums = pyramid_.residuals(
        {rect.x, rect.y + y, rect.width, std::min(kRowsAtOnce, rect.height - y)}, plane);
    inverse_depth_sum += sums.inverse_depth;
    fit.depth_sum += sums.depth;
    fit.point_plane_sum += d * sums.relative;
    const bool off_ray =
        noise_scaled ? inverse_depth_sum > count * options_.tolerance : fit.depth_sum > allowed_sum;
    if (fit.point_plane_sum > allowed_sum || (options_.along_ray_test && off_ray)) {
      return std::nullopt;
    }
  }
  return fit;
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
  for (const int row : {2 * node.row, 2 * node.row + 1}) {
    for (const int column : {2 * node.column, 2 * node.column + 1}) {
      const QuadtreeNode child{node.level + 1, column, row};
      if (pyramid_.count(child) > 0) next_.push_back(child);
    }
  }
}

void QuadtreeFitter::Impl::accept(const QuadtreeNode& node, const TileFit& fit) {
  const Eigen::Vector2d origin = pyramid_.origin(node);
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

}  // namespace planecloud_slam
