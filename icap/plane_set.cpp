// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/plane_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "planecloud_slam/icap/kd_tree.h"

namespace planecloud {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kLevels = 3;
constexpr int kCell = 4;  // side of a cell of the pixel-to-tile map [px]
constexpr int kNoLimit = 1 << 14;

/// Scatters neighbouring rectangles over [0, 2^32): the finaliser of MurmurHash3.
std::uint32_t scatter(const TileRect& rect) {
  std::uint32_t h = static_cast<std::uint32_t>(rect.y) * 8192U + static_cast<std::uint32_t>(rect.x);
  h = (h ^ (h >> 16)) * 0x85ebca6bU;
  h = (h ^ (h >> 13)) * 0xc2b2ae35U;
  return h ^ (h >> 16);
}

/// Makes patches of tiles under one camera and one set of options.
class PatchMaker {
 public:
  PatchMaker(const CameraIntrinsics& camera, const PlaneSetOptions& options)
      : camera_(camera), options_(options) {}

  /// Appends the pieces of the tile that are fit for alignment.
  void cut(const PlanarTile& tile, int max_side, std::vector<PlanePatch>& patches) const {
    const TileRect& rect = tile.rect;
    requireInside(rect);
    if (std::min(rect.width, rect.height) < options_.min_tile) return;
    const int columns = (rect.width + max_side - 1) / max_side;
    const int rows = (rect.height + max_side - 1) / max_side;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const int x0 = rect.x + rect.width * column / columns;
        const int x1 = rect.x + rect.width * (column + 1) / columns;
        const int y0 = rect.y + rect.height * row / rows;
        const int y1 = rect.y + rect.height * (row + 1) / rows;
        add(tile, {x0, y0, x1 - x0, y1 - y0}, patches);
      }
    }
  }

 private:
  void requireInside(const TileRect& rect) const {
    if (rect.x >= 0 && rect.y >= 0 && rect.width > 0 && rect.height > 0 &&
        rect.x <= camera_.width - rect.width && rect.y <= camera_.height - rect.height) {
      return;
    }
    throw std::invalid_argument(
        "PlaneSet: a tile lies outside its image; decode clouds that came "
        "over a network with the checked decoder");
  }

  void add(const PlanarTile& tile, const TileRect& rect, std::vector<PlanePatch>& patches) const {
    const Eigen::Vector3d coefficients = tile.inverse_depth.cast<double>();
    const std::optional<Eigen::Vector2d> uv =
        tangentsAt(camera_, rect.x + 0.5 * (rect.width - 1), rect.y + 0.5 * (rect.height - 1));
    if (!uv) return;
    const Eigen::Vector3d ray(uv->x(), uv->y(), 1.0);
    const double inverse_depth = coefficients.dot(ray);
    if (!(inverse_depth > 1.0 / options_.max_depth) || !std::isfinite(inverse_depth)) return;
    PlanePatch patch;
    patch.rect = rect;
    patch.d = 1.0 / coefficients.norm();
    patch.normal = -patch.d * coefficients;
    patch.centroid = ray / inverse_depth;
    if (patch.d < options_.min_incidence * patch.centroid.norm()) return;
    const double z = patch.centroid.z();
    patch.area = rect.area() * z * z / (camera_.fx * camera_.fy) * (z / patch.d);
    patch.radius = std::sqrt(patch.area / kPi);
    setNoise(tile, patch);
    patches.push_back(patch);
  }

  /// Covariance of the regression `q = alpha u + beta v + gamma` over the whole tile, whose
  /// inverse depths have standard deviation `depth_noise`.
  void setNoise(const PlanarTile& tile, PlanePatch& patch) const {
    const double width = tile.rect.width;
    const double height = tile.rect.height;
    const double correlated = options_.noise_correlation * options_.noise_correlation;
    const double samples = std::max(1.0, width * height / correlated);
    const double sigma_q = options_.depth_noise / std::sqrt(samples);
    const double z = patch.centroid.z();
    const double off_x = patch.rect.x + 0.5 * patch.rect.width - tile.rect.x - 0.5 * width;
    const double off_y = patch.rect.y + 0.5 * patch.rect.height - tile.rect.y - 0.5 * height;
    const double spread =
        1.0 + 12.0 * (off_x * off_x / (width * width) + off_y * off_y / (height * height));
    patch.distance_sigma = sigma_q * z * patch.d * std::sqrt(spread);
    const double sigma_alpha = sigma_q * std::sqrt(12.0) * camera_.fx / width;
    const double sigma_beta = sigma_q * std::sqrt(12.0) * camera_.fy / height;
    patch.normal_sigma = patch.d * std::hypot(sigma_alpha, sigma_beta) / std::sqrt(2.0);
  }

  const CameraIntrinsics& camera_;
  const PlaneSetOptions& options_;
};

Eigen::Matrix<float, 6, 1> joined(const Eigen::Vector3d& centroid, const Eigen::Vector3d& normal,
                                  double normal_length) {
  Eigen::Matrix<float, 6, 1> point;
  point << centroid.cast<float>(), (normal_length * normal).cast<float>();
  return point;
}

std::unique_ptr<const KdTree<6>> makeIndex(const std::vector<PlanePatch>& patches,
                                           double normal_length) {
  std::vector<Eigen::Matrix<float, 6, 1>> points;
  points.reserve(patches.size());
  for (const PlanePatch& patch : patches) {
    points.push_back(joined(patch.centroid, patch.normal, normal_length));
  }
  return std::make_unique<const KdTree<6>>(std::move(points));
}

std::size_t indexOf(PlaneSet::Level level) { return static_cast<std::size_t>(level); }

void sortScattered(std::vector<PlanePatch>& patches) {
  std::sort(patches.begin(), patches.end(), [](const PlanePatch& a, const PlanePatch& b) {
    return std::make_tuple(scatter(a.rect), a.rect.y, a.rect.x) <
           std::make_tuple(scatter(b.rect), b.rect.y, b.rect.x);
  });
}

Image<std::int32_t> mapCells(const std::vector<PlanePatch>& patches, const CameraIntrinsics& k) {
  Image<std::int32_t> cells((k.width + kCell - 1) / kCell, (k.height + kCell - 1) / kCell, -1);
  const auto firstCell = [](int pixel) { return (pixel + kCell - 1 - kCell / 2) / kCell; };
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const TileRect& rect = patches[i].rect;
    const int x_end = std::min(cells.width(), firstCell(rect.x + rect.width));
    const int y_end = std::min(cells.height(), firstCell(rect.y + rect.height));
    for (int y = firstCell(rect.y); y < y_end; ++y) {
      for (int x = firstCell(rect.x); x < x_end; ++x) cells(x, y) = static_cast<std::int32_t>(i);
    }
  }
  return cells;
}

}  // namespace

struct PlaneSet::Contents {
  Contents() {
    for (std::unique_ptr<const KdTree<6>>& index : indices) index = makeIndex({}, 1.0);
  }
  CameraIntrinsics camera;
  double normal_length = 1.0;
  std::array<std::vector<PlanePatch>, kLevels> patches;
  std::array<std::unique_ptr<const KdTree<6>>, kLevels> indices;
  Image<std::int32_t> cells;
};

PlaneSet::PlaneSet() : contents_(std::make_shared<const Contents>()) {}

PlaneSet::PlaneSet(const PlaneCloud& cloud, const PlaneSetOptions& options) {
  options.check();
  cloud.camera.check();
  const std::shared_ptr<Contents> contents = std::make_shared<Contents>();
  contents->camera = cloud.camera;
  contents->normal_length = options.normal_length;
  const PatchMaker maker(cloud.camera, options);
  const std::array<int, kLevels> max_sides{options.coarse_tile, options.fine_tile, kNoLimit};
  for (std::size_t level = 0; level < kLevels; ++level) {
    std::vector<PlanePatch>& patches = contents->patches[level];
    for (const PlanarTile& tile : cloud.tiles) maker.cut(tile, max_sides[level], patches);
    sortScattered(patches);
    contents->indices[level] = makeIndex(patches, options.normal_length);
  }
  contents->cells = mapCells(contents->patches[indexOf(Level::kWhole)], cloud.camera);
  contents_ = contents;
}

const CameraIntrinsics& PlaneSet::camera() const { return contents_->camera; }

const std::vector<PlanePatch>& PlaneSet::patches(Level level) const {
  return contents_->patches[indexOf(level)];
}

Eigen::Vector2d PlaneSet::project(const Eigen::Vector3d& point) const {
  return projectPoint(contents_->camera, point);
}

int PlaneSet::patchAt(int x, int y) const {
  const CameraIntrinsics& k = contents_->camera;
  if (x < 0 || y < 0 || x >= k.width || y >= k.height) return -1;
  return contents_->cells(x / kCell, y / kCell);
}

const KdTree<6>& PlaneSet::index(Level level) const { return *contents_->indices[indexOf(level)]; }

double PlaneSet::normalLength() const { return contents_->normal_length; }

Eigen::Matrix<float, 6, 1> PlaneSet::matchingPoint(const Eigen::Vector3d& centroid,
                                                   const Eigen::Vector3d& normal) const {
  return joined(centroid, normal, contents_->normal_length);
}

}  // namespace planecloud
