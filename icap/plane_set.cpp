// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/plane_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>

namespace planecloud {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kLevels = 3;
constexpr int kCell = 1 << TileView::kCellShift;  // side of a cell of the view [px]
constexpr int kNoLimit = std::numeric_limits<int>::max();
// Smaller tiles know too little of their normals to find a partner by it [px].
constexpr int kLeastCoarseTile = 8;

/// Scatters neighbouring rectangles over [0, 2^32): the finaliser of MurmurHash3.
std::uint32_t scatter(const TileRect& rect) {
  std::uint32_t h = static_cast<std::uint32_t>(rect.y) * 8192U + static_cast<std::uint32_t>(rect.x);
  h = (h ^ (h >> 16)) * 0x85ebca6bU;
  h = (h ^ (h >> 13)) * 0xc2b2ae35U;
  return h ^ (h >> 16);
}

/// A part of a tile that becomes a patch.
struct Piece {
  std::uint32_t order = 0;  // among its like
  TileRect rect;
  const PlanarTile* tile = nullptr;
};

void sortScattered(std::vector<Piece>& pieces) {
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.order, a.rect.y, a.rect.x) < std::tie(b.order, b.rect.y, b.rect.x);
  });
}

/// Which pieces make a level.
struct PieceLimits {
  int min_tile = 0;  // tiles with a smaller side are left out [px]
  int max_side = 0;  // of a piece [px]
  int count = 0;     // pieces kept
};

/// Makes patches of tiles under one camera and one set of options.
class PatchMaker {
 public:
  PatchMaker(const CameraIntrinsics& camera, const PlaneSetOptions& options)
      : camera_(camera), options_(options) {}

  /// The patches of a level, see PlaneSet::patches.
  void sample(const std::vector<PlanarTile>& tiles, const PieceLimits& limits,
              std::vector<PlanePatch>& patches) const {
    std::vector<Piece> pieces;
    for (const PlanarTile& tile : tiles) cut(tile, limits, pieces);
    sortScattered(pieces);
    for (const Piece& piece : pieces) {
      if (patches.size() >= static_cast<std::size_t>(limits.count)) break;
      add(piece, patches);
    }
  }

 private:
  void cut(const PlanarTile& tile, const PieceLimits& limits, std::vector<Piece>& pieces) const {
    const TileRect& rect = tile.rect;
    requireInside(rect);
    if (std::min(rect.width, rect.height) < limits.min_tile) return;
    const int columns = 1 + (rect.width - 1) / limits.max_side;
    const int rows = 1 + (rect.height - 1) / limits.max_side;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const int x0 = rect.x + rect.width * column / columns;
        const int x1 = rect.x + rect.width * (column + 1) / columns;
        const int y0 = rect.y + rect.height * row / rows;
        const int y1 = rect.y + rect.height * (row + 1) / rows;
        const TileRect piece{x0, y0, x1 - x0, y1 - y0};
        pieces.push_back({scatter(piece), piece, &tile});
      }
    }
  }

  /// Appends the patch of a piece when it is fit for alignment.
  void add(const Piece& piece, std::vector<PlanePatch>& patches) const {
    const PlanarTile& tile = *piece.tile;
    const TileRect& rect = piece.rect;
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

  void requireInside(const TileRect& rect) const {
    if (rect.x >= 0 && rect.y >= 0 && rect.width > 0 && rect.height > 0 &&
        rect.x <= camera_.width - rect.width && rect.y <= camera_.height - rect.height) {
      return;
    }
    throw std::invalid_argument(
        "PlaneSet: a tile lies outside its image; decode clouds that came "
        "over a network with the checked decoder");
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
    patch.distance_sigma =
        z * patch.d * std::hypot(sigma_q * std::sqrt(spread), options_.depth_bias);
    const double sigma_alpha = sigma_q * std::sqrt(12.0) * camera_.fx / width;
    const double sigma_beta = sigma_q * std::sqrt(12.0) * camera_.fy / height;
    patch.normal_sigma = patch.d * std::hypot(sigma_alpha, sigma_beta) / std::sqrt(2.0);
  }

  const CameraIntrinsics& camera_;
  const PlaneSetOptions& options_;
};

std::size_t indexOf(PlaneSet::Level level) { return static_cast<std::size_t>(level); }

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

PatchColumns columnsOf(const std::vector<PlanePatch>& patches) {
  PatchColumns columns;
  for (const PlanePatch& patch : patches) {
    columns.add(patch.centroid, patch.normal, patch.radius);
  }
  columns.pad();
  return columns;
}

TileView viewOf(const std::vector<PlanePatch>& tiles, const CameraIntrinsics& camera) {
  TileView view;
  view.camera = camera;
  view.distorted = camera.hasDistortion();
  view.cells = mapCells(tiles, camera);
  for (const PlanePatch& tile : tiles) view.add(tile.normal, tile.d);
  view.add(Eigen::Vector3d::UnitZ(), 0.0);
  return view;
}

}  // namespace

struct PlaneSet::Contents {
  std::array<std::vector<PlanePatch>, kLevels> patches;
  PatchColumns coarse_columns;
  PatchColumns fine_columns;
  TileView view;
};

PlaneSet::PlaneSet() : contents_(std::make_shared<const Contents>()) {}

PlaneSet::PlaneSet(const PlaneCloud& cloud, const PlaneSetOptions& options) {
  options.check();
  cloud.camera.check();
  const std::shared_ptr<Contents> contents = std::make_shared<Contents>();
  const PatchMaker maker(cloud.camera, options);
  const std::array<PieceLimits, kLevels> limits{
      {{std::max(options.min_tile, kLeastCoarseTile), options.coarse_tile, options.coarse_kept},
       {options.min_tile, options.fine_tile, options.fine_patches},
       {options.min_tile, kNoLimit, kNoLimit}}};
  for (std::size_t level = 0; level < kLevels; ++level) {
    maker.sample(cloud.tiles, limits[level], contents->patches[level]);
  }
  contents->coarse_columns = columnsOf(contents->patches[indexOf(Level::kCoarse)]);
  contents->fine_columns = columnsOf(contents->patches[indexOf(Level::kFine)]);
  contents->view = viewOf(contents->patches[indexOf(Level::kWhole)], cloud.camera);
  contents_ = contents;
}

const CameraIntrinsics& PlaneSet::camera() const { return contents_->view.camera; }

const std::vector<PlanePatch>& PlaneSet::patches(Level level) const {
  return contents_->patches[indexOf(level)];
}

const PatchColumns& PlaneSet::coarseColumns() const { return contents_->coarse_columns; }

const PatchColumns& PlaneSet::fineColumns() const { return contents_->fine_columns; }

const TileView& PlaneSet::view() const { return contents_->view; }

}  // namespace planecloud
