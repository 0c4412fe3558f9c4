// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <nanoflann.hpp>
#include <utility>
#include <vector>

namespace planecloud {

/// Nearest neighbours among points of fixed dimension, squared Euclidean distance. nanoflann wants
/// the points to stay where they are, hence neither copyable nor movable.
template <int Dimension>
class KdTree {
 public:
  using Point = Eigen::Matrix<float, Dimension, 1>;

  explicit KdTree(std::vector<Point> points)
      : points_{std::move(points)},
        tree_(Dimension, points_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {
    tree_.buildIndex();
  }
  KdTree(const KdTree&) = delete;
  KdTree& operator=(const KdTree&) = delete;

  [[nodiscard]] std::size_t size() const { return points_.points.size(); }

  /// Indices of the `Count` nearest points, nearest first; the second value is how many there are
  /// (fewer than `Count` when the tree is smaller).
  template <std::size_t Count>
  [[nodiscard]] std::pair<std::array<std::size_t, Count>, std::size_t> nearest(
      const Point& query) const {
    std::array<std::size_t, Count> indices;
    std::array<float, Count> squared_distances;
    const std::size_t found =
        tree_.knnSearch(query.data(), Count, indices.data(), squared_distances.data());
    return {indices, found};
  }

 private:
  static constexpr std::size_t kLeafSize = 8;

  /// The interface nanoflann asks for.
  struct Adaptor {
    std::vector<Point> points;
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t index, std::size_t dimension) const {
      return points[index][static_cast<Eigen::Index>(dimension)];
    }
    template <typename Box>
    [[nodiscard]] bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Metric = nanoflann::L2_Simple_Adaptor<float, Adaptor>;

  Adaptor points_;
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Adaptor, Dimension, std::size_t> tree_;
};

}  // namespace planecloud
