// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <chrono>
#include <cmath>
#include <queue>

#include "plane_fit_peers.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {
namespace {

constexpr int kInitialTile = 24;
constexpr int kMinTile = 3;

class PaperFitter {
 public:
  PaperFitter(const Image<float>& depth, const Camera& camera, double tolerance, int min_tile)
      : depth_(depth), camera_(camera), tolerance_(tolerance), min_tile_(min_tile) {}

  /// Calls `accepted` with each tile that is.
  template <typename Accepted>
  void run(Accepted&& accepted) {
    std::queue<TileRect> queue;
    for (int y = 0; y + kInitialTile <= depth_.height(); y += kInitialTile) {
      for (int x = 0; x + kInitialTile <= depth_.width(); x += kInitialTile) {
        queue.push({x, y, kInitialTile, kInitialTile});
      }
    }
    for (; !queue.empty(); queue.pop()) {
      const TileRect tile = queue.front();
      if (hasCorners(tile) && meanDistance(tile, fit(tile)) <= tolerance_) {
        accepted(tile);
        continue;
      }
      const int half = tile.width / 2;
      if (half < min_tile_) continue;
      for (const int y : {tile.y, tile.y + half}) {
        for (const int x : {tile.x, tile.x + half}) queue.push({x, y, half, half});
      }
    }
  }

  [[nodiscard]] double pixelsWithDepth(const TileRect& tile) const {
    double count = 0.0;
    forPixels(tile, [&](const Eigen::Vector4d&) { count += 1.0; });
    return count;
  }

 private:
  bool hasCorners(const TileRect& tile) const {
    const int right = tile.x + tile.width - 1;
    const int bottom = tile.y + tile.height - 1;
    return depth_(tile.x, tile.y) > 0.0F && depth_(right, tile.y) > 0.0F &&
           depth_(tile.x, bottom) > 0.0F && depth_(right, bottom) > 0.0F;
  }

  template <typename Visit>
  void forPixels(const TileRect& tile, Visit&& visit) const {
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        if (!(depth_(x, y) > 0.0F)) continue;
        visit(Eigen::Vector4d(camera_.tangentsX()(x, y), camera_.tangentsY()(x, y), 1.0,
                              1.0 / static_cast<double>(depth_(x, y))));
      }
    }
  }

  Eigen::Vector4d fit(const TileRect& tile) const {
    Eigen::Matrix4d scatter = Eigen::Matrix4d::Zero();
    forPixels(tile, [&](const Eigen::Vector4d& m) { scatter += m * m.transpose(); });
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(scatter);
    const Eigen::Vector4d plane = solver.eigenvectors().col(0);
    return plane / plane.head<3>().norm();
  }

  double meanDistance(const TileRect& tile, const Eigen::Vector4d& plane) const {
    double sum = 0.0;
    double count = 0.0;
    forPixels(tile, [&](const Eigen::Vector4d& m) {
      sum += std::abs(plane.dot(m)) / m.w();
      count += 1.0;
    });
    return sum / count;
  }

  const Image<float>& depth_;
  const Camera& camera_;
  double tolerance_;
  int min_tile_;
};

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace

ExtractedPlanes extractAsInThePaper(const Image<float>& depth, const Camera& camera,
                                    double tolerance) {
  const auto start = std::chrono::steady_clock::now();
  std::size_t planes = 0;
  PaperFitter(depth, camera, tolerance, kMinTile).run([&](const TileRect&) { ++planes; });
  return {millisecondsSince(start), planes};
}

std::vector<FitProgress> watchThePaper(const Image<float>& depth, const Camera& camera,
                                       double tolerance, int min_tile) {
  std::vector<FitProgress> progress(1);
  const auto start = std::chrono::steady_clock::now();
  PaperFitter fitter(depth, camera, tolerance, min_tile);
  fitter.run([&](const TileRect& tile) {
    FitProgress next = progress.back();
    next.milliseconds = millisecondsSince(start);
    next.covered += fitter.pixelsWithDepth(tile);
    ++next.planes;
    progress.push_back(next);
  });
  return progress;
}

}  // namespace planecloud
