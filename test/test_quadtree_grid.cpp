// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "planecloud_slam/plane_fit/coding_order.h"
#include "planecloud_slam/plane_fit/quadtree_grid.h"

namespace planecloud {
namespace {

/// Sides of the first node of each level.
std::vector<int> sides(const QuadtreeLayout& layout) {
  const QuadtreeGrid grid(layout, 640, 480);
  std::vector<int> result;
  for (int level = 0; level < grid.levels(); ++level)
    result.push_back(grid.rect({level, 0, 0}).width);
  return result;
}

TEST(QuadtreeGrid, HalvesAsThePaperDoes) {
  EXPECT_EQ(sides({24, 24, 2}), (std::vector<int>{24, 12, 6, 3, 2}));
  EXPECT_EQ(sides({40, 40, 3}), (std::vector<int>{40, 20, 10, 5, 3}));
  EXPECT_EQ(sides({64, 64, 4}), (std::vector<int>{64, 32, 16, 8, 4}));
  EXPECT_EQ(sides({80, 60, 4}), (std::vector<int>{80, 40, 20, 10, 5}));
}

TEST(QuadtreeGrid, NodesOfEveryLevelTileTheImageExactly) {
  const std::vector<QuadtreeLayout> layouts = {{24, 24, 2}, {40, 40, 3}, {80, 60, 2}, {64, 64, 4}};
  const int sizes[][2] = {{640, 480}, {848, 480}, {320, 240}, {641, 479}, {16, 16}};
  for (const QuadtreeLayout& layout : layouts) {
    for (const auto& size : sizes) {
      const QuadtreeGrid grid(layout, size[0], size[1]);
      ASSERT_EQ(grid.width(), size[0]);
      ASSERT_EQ(grid.height(), size[1]);
      for (int level = 0; level < grid.levels(); ++level) {
        std::vector<int> covered(static_cast<std::size_t>(size[0] * size[1]));
        for (int row = 0; row < grid.rows(level); ++row) {
          for (int column = 0; column < grid.columns(level); ++column) {
            const TileRect rect = grid.rect({level, column, row});
            for (int y = rect.y; y < rect.y + rect.height; ++y) {
              for (int x = rect.x; x < rect.x + rect.width; ++x) {
                ++covered[static_cast<std::size_t>(y * size[0] + x)];
              }
            }
          }
        }
        for (const int times : covered) ASSERT_EQ(times, 1);
      }
    }
  }
}

TEST(QuadtreeGrid, FindsANodeByItsPixels) {
  const QuadtreeGrid grid({24, 24, 2}, 641, 479);
  for (int level = 0; level < grid.levels(); ++level) {
    for (int row = 0; row < grid.rows(level); ++row) {
      for (int column = 0; column < grid.columns(level); ++column) {
        const TileRect rect = grid.rect({level, column, row});
        const auto node = grid.find(rect);
        ASSERT_EQ(node.has_value(), rect.area() > 0);
        if (node) {
          ASSERT_EQ(grid.rect(*node), rect);
        }
      }
    }
  }
  EXPECT_FALSE(grid.find({1, 0, 24, 24}));
  EXPECT_FALSE(grid.find({0, 0, 24, 12}));
  EXPECT_FALSE(grid.find({-24, 0, 24, 24}));
  EXPECT_FALSE(grid.find({648, 0, 24, 24}));
}

TEST(QuadtreeGrid, RefusesLayoutsOutOfRange) {
  EXPECT_THROW(QuadtreeGrid({1, 64, 4}, 640, 480), std::invalid_argument);
  EXPECT_THROW(QuadtreeGrid({64, 81, 4}, 640, 480), std::invalid_argument);
  EXPECT_THROW(QuadtreeGrid({64, 64, 1}, 640, 480), std::invalid_argument);
  EXPECT_THROW(QuadtreeGrid({8, 64, 16}, 640, 480), std::invalid_argument);
}

TEST(CodingOrder, IsTheBreadthFirstWalk) {
  const QuadtreeGrid grid({64, 64, 4}, 640, 480);
  std::vector<QuadtreeNode> queue;
  for (int row = 0; row < grid.rows(0); ++row) {
    for (int column = 0; column < grid.columns(0); ++column) queue.push_back({0, column, row});
  }
  std::uint64_t last = 0;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const QuadtreeNode node = queue[i];
    const std::uint64_t key = codingKey(grid, node);
    if (i > 0) {
      ASSERT_GT(key, last);
    }
    last = key;
    if (node.level + 1 == grid.levels()) continue;
    for (int child = 0; child < 4; ++child) {
      queue.push_back({node.level + 1, 2 * node.column + child % 2, 2 * node.row + child / 2});
    }
  }
}

TEST(CodingOrder, RefusesStrangersAndOverlaps) {
  const QuadtreeGrid grid({64, 64, 4}, 640, 480);
  PlanarTile large;
  large.rect = {64, 64, 64, 64};
  PlanarTile inside;
  inside.rect = {96, 64, 32, 32};
  PlanarTile stranger;
  stranger.rect = {1, 0, 4, 4};
  EXPECT_THROW(inCodingOrder(grid, {large, inside}), std::invalid_argument);
  EXPECT_THROW(inCodingOrder(grid, {large, large}), std::invalid_argument);
  EXPECT_THROW(inCodingOrder(grid, {stranger}), std::invalid_argument);
  EXPECT_EQ(inCodingOrder(grid, {large}).size(), 1U);
}

}  // namespace
}  // namespace planecloud
