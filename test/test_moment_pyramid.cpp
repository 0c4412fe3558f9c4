// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/depth_traits.h"
#include "planecloud_slam/plane_fit/moment_pyramid.h"
#include "split_all.h"

namespace planecloud {
namespace {

struct Case {
  CameraIntrinsics camera;
  QuadtreeLayout layout;
};

const std::vector<Case> kCases = {
    {testCamera(640, 480), {64, 64, 4}},   {testCamera(848, 480), {64, 64, 4}},
    {testCamera(320, 240), {80, 60, 2}},   {testCamera(641, 479), {64, 64, 4}},
    {testCamera(641, 479), {24, 24, 2}},   {testCamera(640, 480), {40, 40, 3}},
    {distortedTestCamera(), {64, 64, 4}},  {distortedTestCamera(), {64, 64, 8}},
    {distortedTestCamera(), {80, 60, 40}}, {distortedTestCamera(), {24, 24, 5}}};

Image<float> noisyCorridor(const Camera& camera) {
  Image<float> depth = renderCorridor(camera);
  addSensorNoise(depth, 0.5, 3);
  return depth;
}

/// Sums of a node straight from the pixels, in double.
TileMoments sumPixels(const MomentPyramid& pyramid, const TileRect& rect,
                      const Image<float>& depth) {
  TileMoments moments;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      const float q = DepthTraits<float>::inverse(depth(x, y));
      const Eigen::Vector2f tangents = pyramid.tangents(x, y);
      if (q > 0.0F) moments.add(tangents.x(), tangents.y(), q);
    }
  }
  return moments;
}

Eigen::Vector3f vectorOf(const NodePlane& plane) { return {plane.alpha, plane.beta, plane.gamma}; }

void expectClose(const TileMoments& a, const TileMoments& b) {
  ASSERT_EQ(a.n, b.n);
  // Float sums of a few thousand terms, tangents within 0.1 of the origin and, in small nodes,
  // within 1e-5 of what their block's affine function makes of them.
  const double tolerance = 2e-5 * std::max(1.0, a.n) * 0.1;
  const double of_tangents = tolerance + (a.n <= 64.0 ? 1e-5 * a.n : 0.0);
  EXPECT_NEAR(a.u, b.u, of_tangents);
  EXPECT_NEAR(a.v, b.v, of_tangents);
  EXPECT_NEAR(a.uu, b.uu, tolerance);
  EXPECT_NEAR(a.uv, b.uv, tolerance);
  EXPECT_NEAR(a.vv, b.vv, tolerance);
  EXPECT_NEAR(a.q, b.q, 10.0 * tolerance);
  EXPECT_NEAR(a.qu, b.qu, of_tangents);
  EXPECT_NEAR(a.qv, b.qv, of_tangents);
  EXPECT_NEAR(a.qq, b.qq, 10.0 * tolerance);
}

/// Planes are compared where it matters: at the tile's own pixels.
void expectClose(const MomentPyramid& pyramid, const TileRect& rect, const NodePlane& plane,
                 const Eigen::Vector3d& expected) {
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      if (pyramid.inverseDepth(x, y) == 0.0F) continue;
      const Eigen::Vector3d ray = pyramid.tangents(x, y).cast<double>().homogeneous();
      ASSERT_NEAR(vectorOf(plane).cast<double>().dot(ray), expected.dot(ray), 2e-4)
          << rect.width << "x" << rect.height << " at " << rect.x << ", " << rect.y;
    }
  }
}

TEST(MomentPyramid, EqualsTheSumsOverPixelsOnEveryLevel) {
  for (const Case& c : kCases) {
    const auto camera = std::make_shared<const Camera>(c.camera);
    const Image<float> depth = noisyCorridor(*camera);
    MomentPyramid pyramid(camera, c.layout, vectorTileKernels());
    ASSERT_TRUE(pyramid.read(depth.view(), nullptr));
    splitAll(pyramid);
    const QuadtreeGrid& grid = pyramid.grid();
    for (int level = 0; level < grid.levels(); ++level) {
      for (int row = 0; row < grid.rows(level); row += 1 + level) {
        for (int column = 0; column < grid.columns(level); column += 1 + level) {
          const QuadtreeNode node{level, column, row};
          const TileRect rect = grid.rect(node);
          ASSERT_EQ(pyramid.area(node), rect.area());
          const TileMoments expected = sumPixels(pyramid, rect, depth);
          expectClose(pyramid.moments(node), expected);
          if (expected.n < 3.0) continue;
          expectClose(pyramid, rect, pyramid.regress(node), regressInverseDepth(expected));
        }
      }
    }
  }
}

TEST(MomentPyramid, ReadsBothDepthEncodingsAlike) {
  const auto camera = std::make_shared<const Camera>(testCamera());
  const Image<std::uint16_t> millimetres = toMillimetres(noisyCorridor(*camera));
  Image<float> metres(millimetres.width(), millimetres.height());
  for (int y = 0; y < metres.height(); ++y) {
    for (int x = 0; x < metres.width(); ++x) {
      metres(x, y) = static_cast<float>(millimetres(x, y)) / 1000.0F;
    }
  }
  MomentPyramid a(camera, {64, 64, 4}, vectorTileKernels());
  MomentPyramid b(camera, {64, 64, 4}, vectorTileKernels());
  ASSERT_TRUE(a.read(millimetres.view(), nullptr));
  ASSERT_TRUE(b.read(metres.view(), nullptr));
  for (int row = 0; row < a.grid().rows(0); ++row) {
    for (int column = 0; column < a.grid().columns(0); ++column) {
      expectClose(a.moments({0, column, row}), b.moments({0, column, row}));
    }
  }
}

TEST(MomentPyramid, KnowsTheRootMeanSquareOfWhatIsLeft) {
  const auto camera = std::make_shared<const Camera>(testCamera());
  const Image<float> depth = noisyCorridor(*camera);
  MomentPyramid pyramid(camera, {64, 64, 4}, vectorTileKernels());
  ASSERT_TRUE(pyramid.read(depth.view(), nullptr));
  splitAll(pyramid);
  for (int level = 0; level < pyramid.grid().levels(); ++level) {
    for (int row = 0; row < pyramid.grid().rows(level); ++row) {
      for (int column = 0; column < pyramid.grid().columns(level); ++column) {
        const QuadtreeNode node{level, column, row};
        const int count = pyramid.count(node);
        if (count < 4) continue;
        const NodePlane plane = pyramid.regress(node);
        const TileRect rect = pyramid.grid().rect(node);
        double squares = 0.0;
        for (int y = rect.y; y < rect.y + rect.height; ++y) {
          for (int x = rect.x; x < rect.x + rect.width; ++x) {
            if (pyramid.inverseDepth(x, y) == 0.0F) continue;
            const Eigen::Vector2f tangents = pyramid.tangents(x, y);
            const double residual = double{pyramid.inverseDepth(x, y)} - plane.gamma -
                                    plane.alpha * tangents.x() - plane.beta * tangents.y();
            squares += residual * residual;
          }
        }
        // Squares of q up to 1 1/m are summed in float; some 1e-7 of them are lost.
        ASSERT_NEAR(plane.rms * plane.rms, squares / count, 7e-7 + 1e-3 * squares / count);
      }
    }
  }
}

TEST(MomentPyramid, GuessesErrorsFromSomeRows) {
  const auto camera = std::make_shared<const Camera>(testCamera());
  const Image<float> depth = noisyCorridor(*camera);
  MomentPyramid pyramid(camera, {64, 64, 4}, vectorTileKernels());
  ASSERT_TRUE(pyramid.read(depth.view(), nullptr));
  splitAll(pyramid);
  ResidualSums all, some;
  const int cells = pyramid.grid().levels() - 1;
  for (int row = 0; row < pyramid.grid().rows(cells); ++row) {
    for (int column = 0; column < pyramid.grid().columns(cells); ++column) {
      const QuadtreeNode node{cells, column, row};
      if (pyramid.count(node) == 0) continue;
      const NodePlane plane = pyramid.regress(node);
      all.relative += pyramid.residuals(pyramid.grid().rect(node), plane).relative;
      some.relative += pyramid.sampleResiduals(node, plane).relative;
    }
  }
  EXPECT_NEAR(some.relative, all.relative, 0.02 * all.relative);  // 77,000 of 307,000 pixels
}

/// Some pixel of a square with a corner at (x0, y0) has depth.
bool isSeen(const MomentPyramid& pyramid, int x0, int y0, int step_x, int step_y, int side) {
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      if (pyramid.inverseDepth(x0 + x * step_x, y0 + y * step_y) != 0.0F) return true;
    }
  }
  return false;
}

TEST(MomentPyramid, KnowsWhichCornersHaveDepth) {
  for (const Case& c : kCases) {
    const auto camera = std::make_shared<const Camera>(c.camera);
    const Image<float> depth = noisyCorridor(*camera);
    MomentPyramid pyramid(camera, c.layout, vectorTileKernels());
    ASSERT_TRUE(pyramid.read(depth.view(), nullptr));
    int with_depth = 0;
    for (int level = 0; level < pyramid.grid().levels(); ++level) {
      for (int row = 0; row < pyramid.grid().rows(level); ++row) {
        for (int column = 0; column < pyramid.grid().columns(level); ++column) {
          const TileRect rect = pyramid.grid().rect({level, column, row});
          if (rect.area() == 0) continue;
          const int window = std::min(4, (std::min(rect.width, rect.height) + 1) / 2);
          const int right = rect.x + rect.width - 1;
          const int bottom = rect.y + rect.height - 1;
          const bool corners = isSeen(pyramid, rect.x, rect.y, 1, 1, window) &&
                               isSeen(pyramid, right, rect.y, -1, 1, window) &&
                               isSeen(pyramid, rect.x, bottom, 1, -1, window) &&
                               isSeen(pyramid, right, bottom, -1, -1, window);
          ASSERT_EQ(pyramid.hasDepthAtCorners({level, column, row}, window), corners);
          with_depth += corners ? 1 : 0;
        }
      }
    }
    EXPECT_GT(with_depth, 0);
  }
}

TEST(MomentPyramid, CountsChildrenBeforeAndAfterTheSplit) {
  for (const Case& c : kCases) {
    const auto camera = std::make_shared<const Camera>(c.camera);
    const Image<float> depth = noisyCorridor(*camera);
    MomentPyramid pyramid(camera, c.layout, vectorTileKernels());
    ASSERT_TRUE(pyramid.read(depth.view(), nullptr));
    for (int level = 0; level < pyramid.grid().levels(); ++level) {
      const bool has_children = level + 1 < pyramid.grid().levels();
      for (int row = 0; row < pyramid.grid().rows(level); ++row) {
        for (int column = 0; column < pyramid.grid().columns(level); ++column) {
          const QuadtreeNode node{level, column, row};
          const int before = pyramid.countChildren(node);
          int after = 0;
          if (has_children) {
            pyramid.split(node);
            for (const int child_row : {2 * row, 2 * row + 1}) {
              for (const int child_column : {2 * column, 2 * column + 1}) {
                after += pyramid.count({level + 1, child_column, child_row}) > 0 ? 1 : 0;
              }
            }
          }
          ASSERT_EQ(before, after) << "level " << level << ", " << column << ", " << row;
        }
      }
    }
  }
}

template <typename Pixel>
void expectKernelsAgree(const Case& c, const Image<Pixel>& depth) {
  const auto camera = std::make_shared<const Camera>(c.camera);
  MomentPyramid a(camera, c.layout, scalarTileKernels());
  MomentPyramid b(camera, c.layout, vectorTileKernels());
  ASSERT_TRUE(a.read(depth.view(), nullptr));
  ASSERT_TRUE(b.read(depth.view(), nullptr));
  splitAll(a);
  splitAll(b);
  for (int level = 0; level < a.grid().levels(); ++level) {
    for (int row = 0; row < a.grid().rows(level); ++row) {
      for (int column = 0; column < a.grid().columns(level); ++column) {
        const QuadtreeNode node{level, column, row};
        expectClose(a.moments(node), b.moments(node));
        if (a.count(node) < 3) continue;
        const TileRect rect = a.grid().rect(node);
        const NodePlane plane = a.regress(node);
        const ResidualSums scalar = a.residuals(rect, plane);
        const ResidualSums vector = b.residuals(rect, plane);
        // Some float roundings of sums that grow with the number of pixels.
        const double tolerance = 1e-5 * a.count(node);
        ASSERT_NEAR(scalar.inverse_depth, vector.inverse_depth, tolerance);
        ASSERT_NEAR(scalar.relative, vector.relative, tolerance + 1e-4 * scalar.relative);
        ASSERT_NEAR(scalar.depth, vector.depth, tolerance + 1e-4 * scalar.depth);
      }
    }
  }
}

TEST(MomentPyramid, ScalarAndVectorKernelsAgreeAtEveryNode) {
  for (const Case& c : kCases) {
    const Image<float> depth = noisyCorridor(Camera(c.camera));
    expectKernelsAgree(c, depth);
    expectKernelsAgree(c, toMillimetres(depth));
  }
}

TEST(MomentPyramid, ReadsRowsWithAStride) {
  const auto camera = std::make_shared<const Camera>(testCamera(320, 240));
  const Image<float> depth = noisyCorridor(*camera);
  Image<float> wide(400, 240, -1.0F);
  for (int y = 0; y < 240; ++y) std::copy_n(depth.row(y), 320, wide.row(y));
  MomentPyramid a(camera, {64, 64, 4}, vectorTileKernels());
  MomentPyramid b(camera, {64, 64, 4}, vectorTileKernels());
  ASSERT_TRUE(a.read(depth.view(), nullptr));
  ASSERT_TRUE(b.read(ImageView<float>(wide.row(0), 320, 240, 400), nullptr));
  for (int column = 0; column < a.grid().columns(0); ++column) {
    expectClose(a.moments({0, column, 1}), b.moments({0, column, 1}));
  }
}

TEST(MomentPyramid, ForgetsThePreviousImage) {
  const auto camera = std::make_shared<const Camera>(testCamera(320, 240));
  const Image<float> first = noisyCorridor(*camera);
  Image<float> second = renderPlane(*camera, {0.2F, 0.1F, 0.6F});
  addSensorNoise(second, 0.0, 9);
  MomentPyramid used(camera, {64, 64, 4}, vectorTileKernels());
  MomentPyramid fresh(camera, {64, 64, 4}, vectorTileKernels());
  ASSERT_TRUE(used.read(first.view(), nullptr));
  splitAll(used);
  ASSERT_TRUE(used.read(second.view(), nullptr));
  ASSERT_TRUE(fresh.read(second.view(), nullptr));
  splitAll(used);
  splitAll(fresh);
  for (int row = 0; row < used.grid().cellRows(); ++row) {
    for (int column = 0; column < used.grid().cellColumns(); ++column) {
      const QuadtreeNode node{used.grid().levels() - 1, column, row};
      ASSERT_EQ(used.count(node), fresh.count(node));
      if (used.count(node) == 0) continue;
      ASSERT_EQ(vectorOf(used.regress(node)), vectorOf(fresh.regress(node)));
      ASSERT_EQ(used.regress(node).rms, fresh.regress(node).rms);
    }
  }
}

TEST(MomentPyramid, GivesUpWhenAsked) {
  const auto camera = std::make_shared<const Camera>(testCamera());
  MomentPyramid pyramid(camera, {64, 64, 4}, vectorTileKernels());
  const Image<float> depth = renderCorridor(*camera);
  EXPECT_FALSE(pyramid.read(depth.view(), [] { return true; }));
}

TEST(MomentPyramid, NeedsACamera) {
  EXPECT_THROW(MomentPyramid(nullptr, {64, 64, 4}, scalarTileKernels()), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud
