// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

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
  std::vector<float> u, v, inverse_depth;
  std::vector<float> n, q, qu, qv, qq;

  explicit Strip(const std::vector<Pixel>& missing)
      : depth(kRows * kMaxWidth),
        u(kStride * kRows + 16),
        v(u.size()),
        inverse_depth(u.size()),
        n(kStride),
        q(kStride),
        qu(kStride),
        qv(kStride),
        qq(kStride) {
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
  [[nodiscard]] DepthStrip<Pixel> strip(int width, int rows) {
    return {depth.data(),         kMaxWidth, {u.data(), v.data(), kStride},
            inverse_depth.data(), width,     rows};
  }
  [[nodiscard]] ColumnSums sums() { return {n.data(), q.data(), qu.data(), qv.data(), qq.data()}; }
};

Strip<float> floatStrip() {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return Strip<float>({nan, 0.0F, infinity, -infinity, -1.0F, 1e-30F, 1e30F});
}
Strip<std::uint16_t> shortStrip() { return Strip<std::uint16_t>({0, 1, 49}); }

void run(const TileKernels& kernels, Strip<float>& strip, int width, int rows) {
  kernels.sum_columns_f32(strip.strip(width, rows), strip.sums());
}
void run(const TileKernels& kernels, Strip<std::uint16_t>& strip, int width, int rows) {
  kernels.sum_columns_u16(strip.strip(width, rows), strip.sums());
}

template <typename Pixel>
void expectSameSums(Strip<Pixel> a, Strip<Pixel> b) {
  for (const int width : {1, 3, 8, 31, 100}) {
    for (const int rows : {1, 4, 5, 17}) {
      run(scalarTileKernels(), a, width, rows);
      run(vectorTileKernels(), b, width, rows);
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        ASSERT_EQ(a.n[x], b.n[x]);
        // At most 17 terms up to 2.5 1/m: a few float roundings of their sum.
        ASSERT_NEAR(a.q[x], b.q[x], 1e-5);
        ASSERT_NEAR(a.qu[x], b.qu[x], 1e-6);
        ASSERT_NEAR(a.qv[x], b.qv[x], 1e-6);
        ASSERT_NEAR(a.qq[x], b.qq[x], 3e-5);
      }
      for (std::size_t i = 0; i < a.inverse_depth.size(); ++i) {
        ASSERT_FLOAT_EQ(a.inverse_depth[i], b.inverse_depth[i]);
      }
    }
  }
}

TEST(TileKernels, SumFloatColumnsAlike) { expectSameSums(floatStrip(), floatStrip()); }
TEST(TileKernels, SumMillimetreColumnsAlike) { expectSameSums(shortStrip(), shortStrip()); }

TEST(TileKernels, TakeEveryKindOfMissingDepthForNone) {
  Strip<float> strip = floatStrip();
  run(scalarTileKernels(), strip, kMaxWidth, kRows);
  float valid = 0.0F;
  for (std::size_t x = 0; x < kMaxWidth; ++x) {
    valid += strip.n[x];
    EXPECT_TRUE(std::isfinite(strip.q[x]));
  }
  EXPECT_EQ(valid, static_cast<float>(strip.depth.size() - (strip.depth.size() + 6) / 7));
}

TEST(TileKernels, SumCellsAlike) {
  Strip<float> strip = floatStrip();
  run(scalarTileKernels(), strip, kMaxWidth, kRows);
  for (const int cell_width : {2, 3, 4, 5}) {
    const int cells = kMaxWidth / cell_width;
    std::vector<DepthSums> a(static_cast<std::size_t>(cells));
    std::vector<DepthSums> b(a.size());
    std::vector<float> counts_a(a.size());
    std::vector<float> counts_b(a.size());
    scalarTileKernels().sum_cells(strip.sums(), cell_width, cells, a.data(), counts_a.data());
    vectorTileKernels().sum_cells(strip.sums(), cell_width, cells, b.data(), counts_b.data());
    EXPECT_EQ(counts_a, counts_b);
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_NEAR(a[i].q, b[i].q, 3e-5);
      ASSERT_NEAR(a[i].qu, b[i].qu, 3e-6);
      ASSERT_NEAR(a[i].qv, b[i].qv, 3e-6);
      ASSERT_NEAR(a[i].qq, b[i].qq, 1e-4);
    }
  }
}

void expectSameTangentSums(const PixelBlock& pixels) {
  const TangentSums a = scalarTileKernels().sum_tangents(pixels);
  const TangentSums b = vectorTileKernels().sum_tangents(pixels);
  const double tolerance = 1e-7 * pixels.width * pixels.rows;  // tangents up to 0.1
  EXPECT_NEAR(a.u, b.u, tolerance);
  EXPECT_NEAR(a.v, b.v, tolerance);
  EXPECT_NEAR(a.uu, b.uu, tolerance);
  EXPECT_NEAR(a.uv, b.uv, tolerance);
  EXPECT_NEAR(a.vv, b.vv, tolerance);
}

/// Random nodes of 16 pixels, some with holes, some without pixels, some steep.
struct RandomNodes {
  static constexpr std::size_t kNodes = 101;
  std::vector<float> tables[8];
  std::vector<float> full, counts;
  std::vector<DepthSums> sums;

  RandomNodes() : full(kNodes), counts(kNodes), sums(kNodes) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    for (std::vector<float>& table : tables) table.resize(kNodes);
    for (std::size_t i = 0; i < kNodes; ++i) {
      if (i % 13 == 0) continue;
      full[i] = 16.0F;
      counts[i] = i % 5 == 0 ? 11.0F : 16.0F;
      tables[0][i] = 1.0F / 16.0F;
      tables[1][i] = 0.05F * uniform(random);
      tables[2][i] = 0.05F * uniform(random);
      tables[3][i] = tables[4][i] = 0.003F;
      tables[5][i] = 15000.0F;
      tables[6][i] = 200.0F * uniform(random);
      tables[7][i] = 15000.0F;
      const float q = 0.6F + 0.55F * uniform(random);
      const float slope = i % 4 == 0 ? 200.0F : 1.0F;
      sums[i].q = 16.0F * q;
      sums[i].qu = tables[1][i] * sums[i].q + 7e-5F * slope * uniform(random);
      sums[i].qv = tables[2][i] * sums[i].q + 7e-5F * slope * uniform(random);
      sums[i].qq = 16.0F * q * q + 1.0F + 1e-3F * uniform(random);
    }
  }
  [[nodiscard]] FullNodeRows rows() const {
    return {tables[0].data(), tables[1].data(), tables[2].data(), tables[3].data(),
            tables[4].data(), tables[5].data(), tables[6].data(), tables[7].data()};
  }
};

TEST(TileKernels, RegressAndWeighNodesAlike) {
  const RandomNodes nodes;
  std::vector<NodePlane> a(RandomNodes::kNodes), b(RandomNodes::kNodes);
  scalarTileKernels().regress(nodes.sums.data(), nodes.rows(), a.size(), a.data());
  vectorTileKernels().regress(nodes.sums.data(), nodes.rows(), b.size(), b.data());
  int behind = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Of sums of 16, centred: some float roundings times the inverse scatter.
    EXPECT_NEAR(a[i].alpha, b[i].alpha, 1e-4 * std::abs(a[i].alpha) + 0.03);
    EXPECT_NEAR(a[i].beta, b[i].beta, 1e-4 * std::abs(a[i].beta) + 0.03);
    EXPECT_NEAR(a[i].gamma, b[i].gamma, 1e-4 * std::abs(a[i].gamma) + 0.003);
    EXPECT_EQ(std::signbit(a[i].rms), std::signbit(b[i].rms));
    EXPECT_NEAR(a[i].rms, b[i].rms, 1e-3);
    behind += std::signbit(a[i].rms) ? 1 : 0;
  }
  EXPECT_GT(behind, 10);
  EXPECT_LT(behind, 60);
  for (const int power : {0, 1, 2}) {
    std::vector<float> c(a.size()), d(a.size());
    const NodeRows rows{nodes.full.data(), nodes.counts.data(), nodes.sums.data(), a.data()};
    scalarTileKernels().weigh(rows, {0.7F, power}, c.size(), c.data());
    vectorTileKernels().weigh(rows, {0.7F, power}, d.size(), d.data());
    for (std::size_t i = 0; i < c.size(); ++i) {
      EXPECT_FLOAT_EQ(c[i], d[i]);
      const bool whole = nodes.full[i] > 0.0F && nodes.counts[i] == nodes.full[i];
      EXPECT_EQ(c[i] >= 0.0F, whole && !std::signbit(a[i].rms));
    }
  }
}

TEST(TileKernels, MeasureResidualsAlike) {
  Strip<float> strip = floatStrip();
  run(scalarTileKernels(), strip, kMaxWidth, kRows);
  for (const int width : {1, 2, 3, 4, 5, 7, 8, 9, 16, 17, 40, 64, 80}) {
    for (const int rows : {1, 3, 16}) {
      const PixelBlock pixels{
          strip.inverse_depth.data(), {strip.u.data(), strip.v.data(), kStride}, width, rows};
      const ResidualQuery query{pixels, 0.3F, -0.2F, 0.5F};
      expectSameTangentSums(pixels);
      const ResidualSums a = scalarTileKernels().residuals(query);
      const ResidualSums b = vectorTileKernels().residuals(query);
      const auto area = static_cast<float>(width * rows);
      EXPECT_NEAR(a.inverse_depth, b.inverse_depth, 1e-6 * area);
      EXPECT_NEAR(a.relative, b.relative, 5e-6 * area);
      EXPECT_NEAR(a.depth, b.depth, 1e-5 * area);
      if (width > 3) {
        EXPECT_GT(a.depth, 0.0F);
      }
    }
  }
}

}  // namespace
}  // namespace planecloud
