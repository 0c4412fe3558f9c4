// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/flat_surface.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace planecloud {
namespace {

constexpr std::size_t kMostSurfaces = 4;
constexpr int kMostSeeds = 16;         ///< tiles a surface is grown from
constexpr int kSmallestTile = 12;      ///< smaller ones know little and are many [px]
constexpr int kRefinements = 3;        ///< of a plane and its tiles by turns
constexpr double kLeastSide = 0.6;     ///< of a surface [m]
constexpr double kSigmas = 3.0;        ///< a tile may be off its plane
constexpr double kUnevenness = 0.005;  ///< of a flat surface [m]
/// Of a tile's height [m]: beyond, a door could not be told from the wall it is set in.
constexpr double kLargestTolerance = 0.025;
constexpr double kMeanTilt = 0.01;      ///< of all tiles against their common plane [rad]
constexpr double kLeastAngle = 0.05;    ///< likewise of normals [rad]
constexpr double kLargestAngle = 0.25;  ///< however uncertain a normal is [rad]
/// Share of the least area of a surface from which on others that are parallel are rivals.
constexpr double kRivalShare = 0.1;

/// A tile and what it tells of the coefficients of `q = alpha u + beta v + gamma`.
struct Tile {
  Eigen::Vector3d coefficients;
  Eigen::Matrix3d information;  ///< of the coefficients, from the noise of its pixels
  Eigen::Vector3d normal;
  Eigen::Vector3d centroid;   ///< [m]
  double area = 0.0;          ///< [m^2]
  double tolerance = 0.0;     ///< of its height over a plane it is part of [m]
  double normal_sigma = 0.0;  ///< [rad]
  double least_cosine = 0.0;  ///< between its normal and that of a plane it is part of [-]
  int pixels = 0;
  bool used = false;
};

std::optional<Tile> makeTile(const PlanarTile& planar, const CameraIntrinsics& camera,
                             const PlaneSetOptions& options) {
  const TileRect& rect = planar.rect;
  if (std::min(rect.width, rect.height) < kSmallestTile) return std::nullopt;
  const std::optional<Eigen::Vector2d> uv =
      tangentsAt(camera, rect.x + 0.5 * (rect.width - 1), rect.y + 0.5 * (rect.height - 1));
  if (!uv) return std::nullopt;
  const Eigen::Vector3d ray(uv->x(), uv->y(), 1.0);
  Tile tile;
  tile.coefficients = planar.inverse_depth.cast<double>();
  const double q = tile.coefficients.dot(ray);
  if (!(q > 1.0 / options.max_depth) || !std::isfinite(q)) return std::nullopt;
  const double d = 1.0 / tile.coefficients.norm();
  tile.normal = -d * tile.coefficients;
  tile.centroid = ray / q;
  if (d < options.min_incidence * tile.centroid.norm()) return std::nullopt;
  tile.pixels = rect.area();
  const double du = rect.width / camera.fx;
  const double dv = rect.height / camera.fy;
  tile.area = du * dv / (q * q * q * d);
  const double correlated = options.noise_correlation * options.noise_correlation;
  const double samples = std::max(1.0, tile.pixels / correlated);
  Eigen::Matrix3d moments = ray * ray.transpose();
  moments(0, 0) += du * du / 12.0;
  moments(1, 1) += dv * dv / 12.0;
  tile.information = samples / (options.depth_noise * options.depth_noise) * moments;
  const double sigma_q = options.depth_noise / std::sqrt(samples);
  tile.tolerance = kUnevenness + d / q * std::hypot(kSigmas * sigma_q, options.depth_bias);
  if (tile.tolerance > kLargestTolerance) return std::nullopt;
  tile.normal_sigma = d * sigma_q * std::sqrt(6.0 / (du * du) + 6.0 / (dv * dv));
  tile.least_cosine = std::cos(std::min(kLargestAngle, kLeastAngle + kSigmas * tile.normal_sigma));
  return tile;
}

/// Finds surfaces among the tiles of one keyframe.
class SurfaceFinder {
 public:
  SurfaceFinder(const PlaneCloud& planes, double min_area, const IcapOptions& options)
      : min_area_(min_area), options_(options) {
    for (const PlanarTile& planar : planes.tiles) {
      if (std::optional<Tile> tile = makeTile(planar, planes.camera, options.planes)) {
        tiles_.push_back(std::move(*tile));
      }
    }
    std::stable_sort(tiles_.begin(), tiles_.end(),
                     [](const Tile& a, const Tile& b) { return a.pixels > b.pixels; });
  }

  std::vector<FlatSurface> find() {
    std::vector<std::pair<int, FlatSurface>> found;  // with pixels
    int seeds = 0;
    for (Tile& seed : tiles_) {
      if (seed.used) continue;
      if (found.size() == kMostSurfaces || seeds++ == kMostSeeds) break;
      const std::vector<Tile*> members = grow(seed);
      for (Tile* member : members) member->used = true;
      seed.used = true;
      const std::optional<FlatSurface> surface = shape(members);
      if (!surface) continue;
      int pixels = 0;
      for (const Tile* member : members) pixels += member->pixels;
      found.emplace_back(pixels, *surface);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<FlatSurface> surfaces;
    for (auto& [pixels, surface] : found) {
      surface.clearance = clearance(surface);
      surfaces.push_back(surface);
    }
    return surfaces;
  }

 private:
  static bool parallel(const Tile& tile, const Eigen::Vector3d& normal) {
    return tile.normal.dot(normal) > tile.least_cosine;
  }

  /// How far off the tile is for certain [m].
  static double heightOver(const Tile& tile, const Eigen::Vector3d& normal, double d) {
    const double height = std::abs(normal.dot(tile.centroid) + d);
    return height > tile.tolerance ? height : 0.0;
  }

  std::vector<Tile*> grow(const Tile& seed) {
    Eigen::Vector3d coefficients = seed.coefficients;
    std::vector<Tile*> members;
    for (int round = 0; round < kRefinements; ++round) {
      const double d = 1.0 / coefficients.norm();
      const Eigen::Vector3d normal = -d * coefficients;
      members.clear();
      for (Tile& tile : tiles_) {
        const bool fits = parallel(tile, normal) && heightOver(tile, normal, d) == 0.0;
        if (fits && !tile.used) members.push_back(&tile);
      }
      if (members.empty()) break;
      coefficients = regress(members).first;
    }
    return members;
  }

  /// Coefficients that fit all the tiles, with their information.
  static std::pair<Eigen::Vector3d, Eigen::Matrix3d> regress(const std::vector<Tile*>& members) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Tile* tile : members) {
      information += tile->information;
      sum += tile->information * tile->coefficients;
    }
    return {information.ldlt().solve(sum), information};
  }

  [[nodiscard]] std::optional<FlatSurface> shape(const std::vector<Tile*>& members) const {
    FlatSurface surface;
    for (const Tile* tile : members) {
      surface.area += tile->area;
      surface.centroid += tile->area * tile->centroid;
    }
    if (surface.area < min_area_) return std::nullopt;
    const auto [coefficients, information] = regress(members);
    const double d = 1.0 / coefficients.norm();
    surface.normal = -d * coefficients;
    if (!agreesWithNormals(members, surface.normal)) return std::nullopt;
    surface.centroid /= surface.area;
    surface.centroid -= (surface.normal.dot(surface.centroid) + d) * surface.normal;
    const Eigen::Vector2d sides = spread(members, surface);
    if (sides(1) < kLeastSide) return std::nullopt;
    surface.half_sides = 0.5 * sides;
    setNoise(information, d, surface);
    return surface;
  }

  /// Steps of a surface, taken for one plane, tilt the plane but not the tiles.
  static bool agreesWithNormals(const std::vector<Tile*>& members, const Eigen::Vector3d& normal) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 0.0;
    for (const Tile* tile : members) {
      const double certainty = 1.0 / (tile->normal_sigma * tile->normal_sigma);
      sum += certainty * tile->normal;
      weight += certainty;
    }
    return sum.normalized().cross(normal).norm() < kMeanTilt + kSigmas / std::sqrt(weight);
  }

  /// Sets the axes; returns the sides of the rectangle of the same spread, the longer one first.
  static Eigen::Vector2d spread(const std::vector<Tile*>& members, FlatSurface& surface) {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Tile* tile : members) {
      const Eigen::Vector3d offset = tile->centroid - surface.centroid;
      const Eigen::Vector3d across = offset - offset.dot(surface.normal) * surface.normal;
      scatter += tile->area / surface.area * across * across.transpose();
      scatter += tile->area / surface.area * tile->area / 12.0 *
                 (Eigen::Matrix3d::Identity() - surface.normal * surface.normal.transpose());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
    surface.axes.col(0) = eigen.eigenvectors().col(2);
    surface.axes.col(1) = surface.normal.cross(surface.axes.col(0)).normalized();
    return (12.0 * eigen.eigenvalues().tail<2>().reverse()).cwiseMax(0.0).cwiseSqrt();
  }

  /// An error `c` of the coefficients lifts the plane by `d c . x` at its point x.
  void setNoise(const Eigen::Matrix3d& information, double d, FlatSurface& surface) const {
    Eigen::Matrix3d points;
    points << surface.centroid, surface.axes;
    surface.covariance =
        d * d * points.transpose() * information.ldlt().solve(Eigen::Matrix3d(points));
    const double bias = options_.planes.depth_bias * d * surface.centroid.z();
    surface.covariance(0, 0) += bias * bias + options_.distance_floor * options_.distance_floor;
    const double slope = options_.rotation_floor * options_.rotation_floor;
    surface.covariance(1, 1) += slope;
    surface.covariance(2, 2) += slope;
  }

  [[nodiscard]] double clearance(const FlatSurface& surface) const {
    std::vector<std::pair<double, double>> others;  // distance, area
    const double d = -surface.normal.dot(surface.centroid);
    for (const Tile& tile : tiles_) {
      const double height = heightOver(tile, surface.normal, d);
      if (height > 0.0 && parallel(tile, surface.normal)) others.emplace_back(height, tile.area);
    }
    std::sort(others.begin(), others.end());
    double area = 0.0;
    for (const auto& [distance, more] : others) {
      area += more;
      if (area >= kRivalShare * min_area_) return distance;
    }
    return std::numeric_limits<double>::infinity();
  }

  double min_area_;
  const IcapOptions& options_;
  std::vector<Tile> tiles_;
};

}  // namespace

std::vector<FlatSurface> findFlatSurfaces(const PlaneCloud& planes, double min_area,
                                          const IcapOptions& options) {
  return SurfaceFinder(planes, min_area, options).find();
}

}  // namespace planecloud
