// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <utility>

#include "planecloud_slam/frontend_node/alignment_kernel_simd.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/frontend_node/alignment_sum_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, ReferencePoints::kLanes>;
using V = hn::Vec<D>;

constexpr std::size_t kWidest = ReferencePoints::kLanes;
/// Columns whose products are summed: the twist, offset, gain and the residual.
constexpr std::size_t kColumns = kUnknowns + 1;
constexpr std::size_t kOffset = 6, kGain = 7, kError = 8;
constexpr std::size_t kSums = kColumns * (kColumns + 1) / 2;
/// Points whose rows are in the cache at once.
constexpr std::size_t kChunk = 128;
/// Partial sums of this many points are kept in float; a multiple of the chunk.
constexpr std::size_t kFlush = 2048;

/// Whitened rows of a chunk of points, the square root of their weight in them, so that the normal
/// equations are products of columns. Column by column; each holds the rows of the grey residuals,
/// then those of the depth residuals.
struct ChunkRows {
  HWY_ALIGN float values[kColumns * 2 * kChunk];
  std::size_t count = 0;  ///< points

  [[nodiscard]] float* grey(std::size_t column) { return values + column * 2 * count; }
  [[nodiscard]] float* depth(std::size_t column) { return grey(column) + count; }
};

/// Jacobian row `q a, (a x ray)` over the twist of a residual that changes by `q a . dp`.
HWY_INLINE void storeRow(V a1, V a2, V a3, V u, V v, V q, float* first, std::size_t stride) {
  const D d;
  hn::StoreU(hn::Mul(q, a1), d, first);
  hn::StoreU(hn::Mul(q, a2), d, first + stride);
  hn::StoreU(hn::Mul(q, a3), d, first + 2 * stride);
  hn::StoreU(hn::MulSub(v, a3, a2), d, first + 3 * stride);
  hn::StoreU(hn::NegMulAdd(u, a3, a1), d, first + 4 * stride);
  hn::StoreU(hn::MulSub(u, a2, hn::Mul(v, a1)), d, first + 5 * stride);
}

/// See scalar::whiten for the algebra.
HWY_INLINE void fillPoints(const ReferencePoints& points, const ResidualView& residuals,
                           const Whitening& whitening, std::size_t i, std::size_t at,
                           ChunkRows& rows) {
  const D d;
  const V u = hn::LoadU(d, points.u.data() + i), v = hn::LoadU(d, points.v.data() + i);
  const V q = hn::LoadU(d, points.q.data() + i);
  const V r_q = hn::LoadU(d, residuals.q + i);
  const V e2 = hn::Mul(r_q, hn::Set(d, whitening.inverse_q));
  const V e1 =
      hn::Mul(hn::NegMulAdd(hn::Set(d, whitening.slope), r_q, hn::LoadU(d, residuals.grey + i)),
              hn::Set(d, whitening.inverse_grey));
  const V nu = hn::Set(d, whitening.nu);
  const V weight = hn::Div(hn::Mul(hn::LoadU(d, residuals.seen + i), hn::Add(nu, hn::Set(d, 2.0F))),
                           hn::Add(nu, hn::MulAdd(e1, e1, hn::Mul(e2, e2))));
  const V root = hn::Sqrt(weight);
  const V scale_grey = hn::Mul(root, hn::Set(d, whitening.inverse_grey));
  const V scale_q = hn::Mul(root, hn::Set(d, whitening.inverse_q));
  const V slope = hn::Mul(hn::Set(d, whitening.slope), scale_grey);

  const std::size_t stride = 2 * rows.count;
  const V b1 = hn::LoadU(d, points.q_u.data() + i), b2 = hn::LoadU(d, points.q_v.data() + i);
  const V b3 = hn::NegMulAdd(b2, v, hn::NegMulAdd(b1, u, q));
  const V g1 = hn::LoadU(d, points.grey_u.data() + i), g2 = hn::LoadU(d, points.grey_v.data() + i);
  const V g3 = hn::Neg(hn::MulAdd(g1, u, hn::Mul(g2, v)));
  storeRow(hn::MulSub(scale_grey, g1, hn::Mul(slope, b1)),
           hn::MulSub(scale_grey, g2, hn::Mul(slope, b2)),
           hn::MulSub(scale_grey, g3, hn::Mul(slope, b3)), u, v, q, rows.grey(0) + at, stride);
  storeRow(hn::Mul(scale_q, b1), hn::Mul(scale_q, b2), hn::Mul(scale_q, b3), u, v, q,
           rows.depth(0) + at, stride);

  const V centred = hn::Sub(hn::LoadU(d, points.grey.data() + i), hn::Set(d, kMiddleGrey));
  const V gain = hn::Mul(hn::Mul(centred, hn::Set(d, kInverseGreySpread)), scale_grey);
  hn::StoreU(scale_grey, d, rows.grey(kOffset) + at);
  hn::StoreU(gain, d, rows.grey(kGain) + at);
  hn::StoreU(hn::Mul(root, e1), d, rows.grey(kError) + at);
  hn::StoreU(hn::Zero(d), d, rows.depth(kOffset) + at);
  hn::StoreU(hn::Zero(d), d, rows.depth(kGain) + at);
  hn::StoreU(hn::Mul(root, e2), d, rows.depth(kError) + at);
}

/// The products of nine columns, 45 in all, in five passes of nine: row k of their triangle has
/// 9 - k of them and row 9 - k has k, so that every pass keeps its sums in nine registers.
template <std::size_t kPass>
struct Pass {
  static constexpr std::size_t kOther = kPass == 0 ? 0 : kColumns - kPass;
  static constexpr bool isFirst(std::size_t k) { return k < kColumns - kPass; }
  static constexpr std::size_t row(std::size_t k) { return isFirst(k) ? kPass : kOther; }
  static constexpr std::size_t column(std::size_t k) { return isFirst(k) ? kPass + k : k; }
};

template <std::size_t kPass>
HWY_INLINE void addProducts(ChunkRows& rows, float* all_sums) {
  const D d;
  using P = Pass<kPass>;
  float* sums = all_sums + kPass * kColumns * kWidest;
  const auto load = [&](std::size_t k) HWY_ATTR { return hn::Load(d, sums + k * kWidest); };
  V s0 = load(0), s1 = load(1), s2 = load(2), s3 = load(3), s4 = load(4);
  V s5 = load(5), s6 = load(6), s7 = load(7), s8 = load(8);
  const float* first = rows.grey(kPass);
  const float* other = rows.grey(P::kOther);
  for (std::size_t i = 0; i < 2 * rows.count; i += hn::Lanes(d)) {
    const V a = hn::LoadU(d, first + i), b = hn::LoadU(d, other + i);
    const auto add = [&](V sum, std::size_t k) HWY_ATTR {
      return hn::MulAdd(P::isFirst(k) ? a : b, hn::LoadU(d, rows.grey(P::column(k)) + i), sum);
    };
    s0 = add(s0, 0), s1 = add(s1, 1), s2 = add(s2, 2), s3 = add(s3, 3), s4 = add(s4, 4);
    s5 = add(s5, 5), s6 = add(s6, 6), s7 = add(s7, 7), s8 = add(s8, 8);
  }
  const auto store = [&](V sum, std::size_t k) HWY_ATTR { hn::Store(sum, d, sums + k * kWidest); };
  store(s0, 0), store(s1, 1), store(s2, 2), store(s3, 3), store(s4, 4);
  store(s5, 5), store(s6, 6), store(s7, 7), store(s8, 8);
}

void addEntry(std::size_t row, std::size_t column, double sum, NormalEquations& equations) {
  const auto r = static_cast<Eigen::Index>(row);
  if (column < kError) {
    equations.matrix(r, static_cast<Eigen::Index>(column)) += sum;
  } else if (row < kError) {
    equations.vector(r) += sum;
  } else {
    equations.error += sum;
  }
}

/// Adds the float sums of one pass to `equations` and clears them.
template <std::size_t kPass>
void flushPass(float* all_sums, NormalEquations& equations) {
  for (std::size_t k = 0; k < kColumns; ++k) {
    float* lanes = all_sums + (kPass * kColumns + k) * kWidest;
    double sum = 0.0;
    for (std::size_t lane = 0; lane < kWidest; ++lane) sum += static_cast<double>(lanes[lane]);
    std::fill(lanes, lanes + kWidest, 0.0F);
    addEntry(Pass<kPass>::row(k), Pass<kPass>::column(k), sum, equations);
  }
}

template <std::size_t... kPasses>
HWY_INLINE void addChunk(ChunkRows& rows, float* sums, std::index_sequence<kPasses...>) {
  (addProducts<kPasses>(rows, sums), ...);
}

template <std::size_t... kPasses>
void flush(float* sums, NormalEquations& equations, std::index_sequence<kPasses...>) {
  (flushPass<kPasses>(sums, equations), ...);
}

void sum(const ReferencePoints& points, const ResidualView& residuals, const Whitening& whitening,
         NormalEquations& equations) {
  constexpr std::make_index_sequence<kSums / kColumns> kPasses;
  HWY_ALIGN float sums[kSums * kWidest] = {};
  ChunkRows rows;
  for (std::size_t begin = 0; begin < residuals.count; begin += kChunk) {
    rows.count = std::min(kChunk, residuals.count - begin);
    for (std::size_t k = 0; k < rows.count; k += hn::Lanes(D())) {
      fillPoints(points, residuals, whitening, begin + k, k, rows);
    }
    addChunk(rows, sums, kPasses);
    if ((begin + kChunk) % kFlush == 0) flush(sums, equations, kPasses);
  }
  flush(sums, equations, kPasses);
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(sum);

SumKernel vectorSum() {
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return &HWY_DYNAMIC_DISPATCH(sum);
}

}  // namespace planecloud
#endif  // HWY_ONCE
