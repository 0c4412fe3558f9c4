// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "planecloud_slam/plane_fit/moment_list.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

namespace planecloud {
namespace {

constexpr int kRows = 17;
constexpr int kMaxWidth = 100;
constexpr std::ptrdiff_t kStride = 128;

/// One strip of random pixels with every kind of missing depth, and all that kernels write.
template <typename Pixel>
struct Strip {
  std::vector<Pixel> depth;
  std::vector<float> u, v;
  std::vector<float> n, q, qy, qq;

  explicit Strip(const std::vector<Pixel>& missing)
      : depth(kRows * kMaxWidth),
        u(kStride * kRows),
        v(u.size()),
        n(kMaxWidth),
        q(kMaxWidth),
        qy(kMaxWidth),
        qq(kMaxWidth) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    const float unit = std::is_same_v<Pixel, float> ? 1.0F : 1000.0F;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      depth[i] = static_cast<Pixel>(unit * (0.4F + 7.0F * uniform(random)));
      if (i % 7 == 0) depth[i] = missing[i / 7 % missing.size()];
    }
    for (float& tangent : u) tangent = 0.2F * (uniform(random) - 0.5F);
    for (float& tangent : v) tangent = 0.2F * (uniform(random) - 0.5F);
  }
  /// The last pixels of the last rows: whoever reads on leaves the vector.
  [[nodiscard]] DepthBlock<Pixel> block(int width, int rows) const {
    return {depth.data() + depth.size() - offset(width, rows, kMaxWidth), kMaxWidth, width, rows};
  }
  [[nodiscard]] TangentRows tangents(int width, int rows) const {
    const std::size_t first = u.size() - offset(width, rows, kStride);
    return {u.data() + first, v.data() + first, kStride};
  }
  [[nodiscard]] ColumnSums sums() { return {n.data(), q.data(), qy.data(), qq.data()}; }
  void sumColumns(const TileKernels& kernels, int width, int rows) {
    kernels.of<Pixel>().sum_columns(block(width, rows), sums());
  }

 private:
  [[nodiscard]] static std::size_t offset(int width, int rows, std::ptrdiff_t stride) {
    return static_cast<std::size_t>((rows - 1) * stride + width);
  }
};

Strip<float> floatStrip() {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return Strip<float>({nan, 0.0F, infinity, -infinity, -1.0F, 1e-30F, 1e30F});
}
Strip<std::uint16_t> shortStrip() { return Strip<std::uint16_t>({0, 1, 49}); }

template <typename Pixel>
void expectSameColumns(Strip<Pixel> a, Strip<Pixel> b) {
  for (const int width : {1, 3, 8, 31, 100}) {
    for (const int rows : {1, 4, 5, 17}) {
      a.sumColumns(scalarTileKernels(), width, rows);
      b.sumColumns(vectorTileKernels(), width, rows);
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        ASSERT_EQ(a.n[x], b.n[x]);
        // At most 17 terms up to 2.5 1/m: a few float roundings of their sum.
        ASSERT_NEAR(a.q[x], b.q[x], 1e-5);
        ASSERT_NEAR(a.qy[x], b.qy[x], 1e-4);
        ASSERT_NEAR(a.qq[x], b.qq[x], 3e-5);
      }
    }
  }
}

TEST(TileKernels, SumFloatColumnsAlike) { expectSameColumns(floatStrip(), floatStrip()); }
TEST(TileKernels, SumMillimetreColumnsAlike) { expectSameColumns(shortStrip(), shortStrip()); }

TEST(TileKernels, TakeEveryKindOfMissingDepthForNone) {
  Strip<float> strip = floatStrip();
  strip.sumColumns(scalarTileKernels(), kMaxWidth, kRows);
  float valid = 0.0F;
  for (std::size_t x = 0; x < kMaxWidth; ++x) {
    valid += strip.n[x];
    EXPECT_TRUE(std::isfinite(strip.q[x]));
  }
  EXPECT_EQ(valid, static_cast<float>(strip.depth.size() - (strip.depth.size() + 6) / 7));
}

/// Cells so many columns wide, the last one narrower, with tangents of their own.
struct RandomCells {
  std::vector<int> edges{0};
  std::vector<float> tables[6];

  explicit RandomCells(int width) {
    while (edges.back() < kMaxWidth) edges.push_back(std::min(edges.back() + width, kMaxWidth));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-0.1F, 0.1F);
    for (std::vector<float>& table : tables) {
      table.resize(edges.size() - 1);
      for (float& value : table) value = uniform(random);
    }
  }
  [[nodiscard]] CellRow row() const {
    const int cells = static_cast<int>(edges.size()) - 1;
    return {edges.data(),
            cells,
            kMaxWidth / edges[1],
            kRows,
            {tables[0].data(), tables[1].data(), tables[2].data(), tables[3].data(),
             tables[4].data(), tables[5].data()}};
  }
};

struct CellResults {
  std::vector<DepthSums> depth;
  std::vector<float> counts, distortions;
  std::vector<Fill> fills;

  explicit CellResults(int cells)
      : depth(static_cast<std::size_t>(cells)),
        counts(depth.size()),
        distortions(depth.size()),
        fills(depth.size()) {}
  [[nodiscard]] CellSums pointers() {
    return {depth.data(), counts.data(), fills.data(), distortions.data()};
  }
};

const DistortionRule kRule{0.7F, 1};

TEST(TileKernels, SumCellsAlike) {
  Strip<float> strip = floatStrip();
  strip.sumColumns(scalarTileKernels(), kMaxWidth, kRows);
  for (const int cell_width : {2, 3, 4, 5, 8}) {
    const RandomCells cells(cell_width);
    const CellRow row = cells.row();
    CellResults a(row.cells), b(row.cells);
    scalarTileKernels().sum_cells(strip.sums(), row, kRule, a.pointers());
    vectorTileKernels().sum_cells(strip.sums(), row, kRule, b.pointers());
    EXPECT_EQ(a.counts, b.counts);
    EXPECT_EQ(a.fills, b.fills);
    for (std::size_t i = 0; i < a.depth.size(); ++i) {
      ASSERT_NEAR(a.depth[i].q, b.depth[i].q, 3e-5);
      ASSERT_NEAR(a.depth[i].qu, b.depth[i].qu, 5e-5);
      ASSERT_NEAR(a.depth[i].qv, b.depth[i].qv, 5e-5);
      ASSERT_NEAR(a.depth[i].qq, b.depth[i].qq, 1e-4);
      ASSERT_NEAR(a.distortions[i], b.distortions[i], 1e-4 * std::abs(a.distortions[i]));
    }
  }
}

/// Random nodes of 16 pixels, some with holes, some without pixels, some steep.
struct RandomNodes {
  static constexpr std::size_t kNodes = 101;
  std::vector<float> tables[9];
  std::vector<DepthSums> sums;

  RandomNodes() : sums(kNodes) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    for (std::vector<float>& table : tables) table.resize(kNodes);
    for (std::size_t i = 0; i < kNodes; ++i) {
      if (i % 13 == 0) continue;
      tables[0][i] = 16.0F;
      tables[1][i] = 1.0F / 16.0F;
      tables[2][i] = 0.05F * uniform(random);
      tables[3][i] = 0.05F * uniform(random);
      tables[4][i] = tables[5][i] = 0.003F;
      tables[6][i] = 15000.0F;
      tables[7][i] = 200.0F * uniform(random);
      tables[8][i] = 15000.0F;
      const float q = 0.6F + 0.55F * uniform(random);
      const float slope = i % 4 == 0 ? 200.0F : 1.0F;
      sums[i].q = 16.0F * q;
      sums[i].qu = tables[2][i] * sums[i].q + 7e-5F * slope * uniform(random);
      sums[i].qv = tables[3][i] * sums[i].q + 7e-5F * slope * uniform(random);
      sums[i].qq = 16.0F * q * q + 1.0F + 1e-3F * uniform(random);
    }
  }
  [[nodiscard]] FullNodeRows rows() const {
    return {tables[0].data(), tables[1].data(), tables[2].data(),
            tables[3].data(), tables[4].data(), tables[5].data(),
            tables[6].data(), tables[7].data(), tables[8].data()};
  }
};

TEST(TileKernels, RegressAndWeighNodesAlike) {
  const RandomNodes nodes;
  std::vector<NodePlane> a(RandomNodes::kNodes), b(RandomNodes::kNodes);
  std::vector<float> c(a.size()), d(a.size());
  const PlaneFits scalar{a.data(), c.data()};
  const PlaneFits vector{b.data(), d.data()};
  scalarTileKernels().regress(nodes.sums.data(), nodes.rows(), kRule, a.size(), scalar);
  vectorTileKernels().regress(nodes.sums.data(), nodes.rows(), kRule, a.size(), vector);
  int behind = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Of sums of 16, centred: some float roundings times the inverse scatter.
    EXPECT_NEAR(a[i].alpha, b[i].alpha, 1e-4 * std::abs(a[i].alpha) + 0.03);
    EXPECT_NEAR(a[i].beta, b[i].beta, 1e-4 * std::abs(a[i].beta) + 0.03);
    EXPECT_NEAR(a[i].gamma, b[i].gamma, 1e-4 * std::abs(a[i].gamma) + 0.003);
    EXPECT_EQ(std::signbit(a[i].rms), std::signbit(b[i].rms));
    EXPECT_NEAR(a[i].rms, b[i].rms, 1e-3);
    behind += std::signbit(a[i].rms) ? 1 : 0;
    EXPECT_EQ(c[i] < 0.0F, std::signbit(a[i].rms));
    EXPECT_NEAR(c[i], d[i], 1e-3 + 0.02 * std::abs(c[i]));
  }
  EXPECT_GT(behind, 10);
  EXPECT_LT(behind, 60);
}

TEST(TileKernels, WeighByThePowerOfDepth) {
  const RandomNodes nodes;
  for (const TileKernels* kernels : {&scalarTileKernels(), &vectorTileKernels()}) {
    for (const int power : {0, 1, 2}) {
      std::vector<NodePlane> planes(RandomNodes::kNodes);
      std::vector<float> distortions(planes.size());
      kernels->regress(nodes.sums.data(), nodes.rows(), {0.7F, power}, planes.size(),
                       {planes.data(), distortions.data()});
      for (std::size_t i = 0; i < planes.size(); ++i) {
        if (std::signbit(planes[i].rms)) continue;
        const double depth = 16.0 / nodes.sums[i].q;
        const double expected = 0.7 * 16.0 * planes[i].rms * std::pow(depth, power);
        EXPECT_NEAR(distortions[i], expected, 1e-4 * expected);
      }
    }
  }
}

TEST(TileKernels, RegressMomentsAlike) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  MomentList a, b;
  for (std::size_t i = 0; i < 99; ++i) {
    TileMoments moments;
    const std::size_t pixels = 1 + i % 9;
    const double across = i % 3 == 0 ? 0.0 : 0.05;  // some in one row
    for (std::size_t j = 0; j < pixels; ++j) {
      moments.add(0.05 * uniform(random), across * uniform(random), 0.5 + 0.01 * uniform(random));
    }
    a.add(i, moments);
    b.add(i, moments);
  }
  a.regress(scalarTileKernels());
  b.regress(vectorTileKernels());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(b.node(i), i);
    EXPECT_NEAR(a.plane(i).alpha, b.plane(i).alpha, 1e-5);
    EXPECT_NEAR(a.plane(i).beta, b.plane(i).beta, 1e-5);
    EXPECT_NEAR(a.plane(i).gamma, b.plane(i).gamma, 1e-6);
    EXPECT_NEAR(a.plane(i).rms, b.plane(i).rms, 1e-6);
    EXPECT_TRUE(std::isfinite(b.plane(i).rms));
  }
}

template <typename Pixel>
void expectSameBlocks(const Strip<Pixel>& strip) {
  const NodePlane plane{0.3F, -0.2F, 0.5F, 0.0F};
  const PixelKernels<Pixel>& scalar = scalarTileKernels().of<Pixel>();
  const PixelKernels<Pixel>& vector = vectorTileKernels().of<Pixel>();
  for (const int width : {1, 2, 3, 4, 5, 7, 8, 9, 16, 17, 40, 64, 80}) {
    for (const int rows : {1, 3, 16}) {
      const DepthBlock<Pixel> block = strip.block(width, rows);
      const TangentRows tangents = strip.tangents(width, rows);
      const auto area = static_cast<float>(width * rows);
      const BlockSums c = scalar.sum_block(block, tangents);
      const BlockSums d = vector.sum_block(block, tangents);
      EXPECT_NEAR(c.tangents.u, d.tangents.u, 1e-7 * area);  // tangents up to 0.1
      EXPECT_NEAR(c.tangents.v, d.tangents.v, 1e-7 * area);
      EXPECT_NEAR(c.tangents.uu, d.tangents.uu, 1e-7 * area);
      EXPECT_NEAR(c.tangents.uv, d.tangents.uv, 1e-7 * area);
      EXPECT_NEAR(c.tangents.vv, d.tangents.vv, 1e-7 * area);
      EXPECT_NEAR(c.qu, d.qu, 3e-7 * area);
      EXPECT_NEAR(c.qv, d.qv, 3e-7 * area);
      const ResidualSums a = scalar.residuals(block, tangents, plane);
      const ResidualSums b = vector.residuals(block, tangents, plane);
      EXPECT_NEAR(a.inverse_depth, b.inverse_depth, 1e-6 * area);
      EXPECT_NEAR(a.relative, b.relative, 5e-6 * area);
      EXPECT_NEAR(a.depth, b.depth, 1e-5 * area);
      if (area > 3) {
        EXPECT_GT(a.depth, 0.0F);
      }
    }
  }
}

TEST(TileKernels, MeasureResidualsOfMetresAlike) { expectSameBlocks(floatStrip()); }
TEST(TileKernels, MeasureResidualsOfMillimetresAlike) { expectSameBlocks(shortStrip()); }

}  // namespace
}  // namespace planecloud
