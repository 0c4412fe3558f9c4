// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>

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
constexpr int kTwist = 6;
/// Columns of the Jacobian beside the residual: twist, offset, gain, residual.
constexpr int kColumns = 9;
constexpr int kResidual = 8;
/// Points whose columns are in cache together. Partial sums of so many chunks are kept in float.
constexpr std::size_t kChunk = 128;
constexpr std::size_t kFlush = 16 * kChunk;

/// Columns `q a, (a x ray)` over the twist of a residual that changes by `q a . dp`.
HWY_INLINE void storeTwist(V a1, V a2, V a3, V u, V v, V q, float* columns, std::size_t stride) {
  const D d;
  hn::Store(hn::Mul(q, a1), d, columns);
  hn::Store(hn::Mul(q, a2), d, columns + stride);
  hn::Store(hn::Mul(q, a3), d, columns + 2 * stride);
  hn::Store(hn::MulSub(v, a3, a2), d, columns + 3 * stride);
  hn::Store(hn::NegMulAdd(u, a3, a1), d, columns + 4 * stride);
  hn::Store(hn::MulSub(u, a2, hn::Mul(v, a1)), d, columns + 5 * stride);
}

/// The columns of some points for both whitened residuals, times the root of the points' weights
/// (0 when not seen): see scalar::whiten. Inverse depth has none of brightness, these stay zero.
template <std::size_t kPoints>
struct WeightedColumns {
  HWY_ALIGN float grey[kColumns * kPoints] = {};
  HWY_ALIGN float q[kColumns * kPoints] = {};
  HWY_ALIGN float root[kPoints];  ///< of the weights

  /// Of the points from `i` on: the roots of their weights and the residuals times these.
  HWY_INLINE void weigh(const ResidualView& residuals, const Whitening& whitening, std::size_t i,
                        std::size_t k) {
    const D d;
    const V r_q = hn::LoadU(d, residuals.q + i);
    const V e2 = hn::Mul(r_q, hn::Set(d, whitening.inverse_q));
    const V e1 =
        hn::Mul(hn::NegMulAdd(hn::Set(d, whitening.slope), r_q, hn::LoadU(d, residuals.grey + i)),
                hn::Set(d, whitening.inverse_grey));
    const V nu = hn::Set(d, whitening.nu);
    const V square = hn::MulAdd(e1, e1, hn::Mul(e2, e2));
    const V weight =
        hn::Div(hn::Mul(hn::LoadU(d, residuals.seen + i), hn::Add(nu, hn::Set(d, 2.0F))),
                hn::Add(nu, square));
    const V scale = hn::Sqrt(weight);
    hn::Store(scale, d, root + k);
    hn::Store(hn::Mul(scale, e1), d, grey + kResidual * kPoints + k);
    hn::Store(hn::Mul(scale, e2), d, q + kResidual * kPoints + k);
  }

  /// Those of the points from `i` on, in the places from `k` on.
  HWY_INLINE void store(const ReferencePoints& points, const Whitening& whitening, std::size_t i,
                        std::size_t k) {
    const D d;
    const V u = hn::LoadU(d, points.u.data() + i), v = hn::LoadU(d, points.v.data() + i);
    const V q_point = hn::LoadU(d, points.q.data() + i);
    const V scale = hn::Load(d, root + k);
    const V inverse_q = hn::Mul(scale, hn::Set(d, whitening.inverse_q));
    const V inverse_grey = hn::Mul(scale, hn::Set(d, whitening.inverse_grey));
    const V to_q = hn::Set(d, whitening.slope * whitening.inverse_grey / whitening.inverse_q);
    const V b1 = hn::Mul(hn::LoadU(d, points.q_u.data() + i), inverse_q);
    const V b2 = hn::Mul(hn::LoadU(d, points.q_v.data() + i), inverse_q);
    const V b3 = hn::NegMulAdd(b2, v, hn::NegMulAdd(b1, u, hn::Mul(q_point, inverse_q)));
    const V i1 = hn::Mul(hn::LoadU(d, points.grey_u.data() + i), inverse_grey);
    const V i2 = hn::Mul(hn::LoadU(d, points.grey_v.data() + i), inverse_grey);
    const V i3 = hn::Neg(hn::MulAdd(i1, u, hn::Mul(i2, v)));
    storeTwist(hn::NegMulAdd(to_q, b1, i1), hn::NegMulAdd(to_q, b2, i2),
               hn::NegMulAdd(to_q, b3, i3), u, v, q_point, grey + k, kPoints);
    storeTwist(b1, b2, b3, u, v, q_point, q + k, kPoints);
    const V contrast =
        hn::Mul(hn::Sub(hn::LoadU(d, points.grey.data() + i), hn::Set(d, kMiddleGrey)),
                hn::Set(d, kInverseGreySpread));
    hn::Store(inverse_grey, d, grey + kTwist * kPoints + k);
    hn::Store(hn::Mul(contrast, inverse_grey), d, grey + (kTwist + 1) * kPoints + k);
  }
};

using ChunkColumns = WeightedColumns<kChunk>;

/// Three columns of a vector of points.
struct Three {
  HWY_INLINE Three(const float* columns, std::size_t k)
      : a(hn::Load(D(), columns + k)),
        b(hn::Load(D(), columns + kChunk + k)),
        c(hn::Load(D(), columns + 2 * kChunk + k)) {}
  V a, b, c;
};

/// Products of three columns with three, summed in registers; of a diagonal block the upper
/// triangle.
template <bool kDiagonal>
struct ProductBlock {
  V aa, ab, ac, ba, bb, bc, ca, cb, cc;

  HWY_INLINE ProductBlock() { aa = ab = ac = ba = bb = bc = ca = cb = cc = hn::Zero(D()); }
  HWY_INLINE void add(const Three& row, const Three& column) {
    aa = hn::MulAdd(row.a, column.a, aa);
    ab = hn::MulAdd(row.a, column.b, ab);
    bb = hn::MulAdd(row.b, column.b, bb);
    if (!kDiagonal) {
      ba = hn::MulAdd(row.b, column.a, ba);
      ca = hn::MulAdd(row.c, column.a, ca);
      cb = hn::MulAdd(row.c, column.b, cb);
    }
    addLast(row, column.c);
  }
  /// With the last of three columns, the others being zero.
  HWY_INLINE void addLast(const Three& row, V column) {
    ac = hn::MulAdd(row.a, column, ac);
    bc = hn::MulAdd(row.b, column, bc);
    cc = hn::MulAdd(row.c, column, cc);
  }
  HWY_INLINE void addTo(float* sums) const {
    for (const V sum : {aa, ab, ac, ba, bb, bc, ca, cb, cc}) {
      hn::Store(hn::Add(sum, hn::Load(D(), sums)), D(), sums);
      sums += kWidest;
    }
  }
};

/// Sums of products of the columns' threes, by blocks: 00, 01, 02, 11, 12, 22.
constexpr std::size_t kBlockSize = 9 * kWidest;
constexpr std::size_t kBlocks = 6;
constexpr std::size_t kLastThree = 2;

template <std::size_t kRow, std::size_t kColumn>
void addProducts(const ChunkColumns& columns, std::size_t size, float* sums) {
  constexpr std::size_t kThree = 3 * kChunk;
  // Additions to one sum wait for each other: two sums of each product, where registers suffice.
  ProductBlock<kRow == kColumn> first, second;
  ProductBlock<kRow == kColumn>& other = kRow == 0 && kColumn == 1 ? first : second;
  for (std::size_t k = 0; k < size; k += hn::Lanes(D())) {
    first.add({columns.grey + kRow * kThree, k}, {columns.grey + kColumn * kThree, k});
    const Three q(columns.q + kRow * kThree, k);
    if (kColumn == kLastThree) {
      other.addLast(q, hn::Load(D(), columns.q + kResidual * kChunk + k));
    } else {
      other.add(q, {columns.q + kColumn * kThree, k});
    }
  }
  first.addTo(sums);
  second.addTo(sums);
}

void addChunk(const ChunkColumns& columns, std::size_t size, float* sums) {
  addProducts<0, 0>(columns, size, sums);
  addProducts<0, 1>(columns, size, sums + kBlockSize);
  addProducts<0, 2>(columns, size, sums + 2 * kBlockSize);
  addProducts<1, 1>(columns, size, sums + 3 * kBlockSize);
  addProducts<1, 2>(columns, size, sums + 4 * kBlockSize);
  addProducts<2, 2>(columns, size, sums + 5 * kBlockSize);
}

/// Adds the float sums to `equations` and clears them.
void flush(float* sums, NormalEquations& equations) {
  constexpr int kFirstBlock[] = {0, 3, 5};
  for (int row = 0; row < kColumns; ++row) {
    for (int column = row; column < kColumns; ++column) {
      const int block = kFirstBlock[row / 3] + column / 3 - row / 3;
      const float* lanes = sums + (9 * block + 3 * (row % 3) + column % 3) * int{kWidest};
      double sum = 0.0;
      for (std::size_t lane = 0; lane < kWidest; ++lane) sum += static_cast<double>(lanes[lane]);
      if (column < kResidual) {
        equations.matrix(row, column) += sum;
      } else {
        (row < kResidual ? equations.vector(row) : equations.error) += sum;
      }
    }
  }
  std::fill(sums, sums + kBlocks * kBlockSize, 0.0F);
}

void sum(const ReferencePoints& points, const ResidualView& residuals, const Whitening& whitening,
         NormalEquations& equations) {
  HWY_ALIGN float sums[kBlocks * kBlockSize] = {};
  ChunkColumns columns;
  for (std::size_t begin = 0; begin < residuals.count; begin += kChunk) {
    const std::size_t size = std::min(kChunk, residuals.count - begin);
    for (std::size_t k = 0; k < size; k += hn::Lanes(D())) {
      columns.weigh(residuals, whitening, begin + k, k);
    }
    for (std::size_t k = 0; k < size; k += hn::Lanes(D())) {
      columns.store(points, whitening, begin + k, k);
    }
    addChunk(columns, size, sums);
    if ((begin + kChunk) % kFlush == 0) flush(sums, equations);
  }
  flush(sums, equations);
}

/// Gradients of the points from `i` on, `kUnknowns` rows of lanes.
HWY_INLINE void storeGradients(const ReferencePoints& points, const ResidualView& residuals,
                               const Whitening& whitening, std::size_t i, float* gradients) {
  const D d;
  WeightedColumns<kWidest> columns;
  columns.weigh(residuals, whitening, i, 0);
  columns.store(points, whitening, i, 0);
  const V e1 = hn::Load(d, columns.grey + kResidual * kWidest);
  const V e2 = hn::Load(d, columns.q + kResidual * kWidest);
  for (std::size_t k = 0; k < kUnknowns * kWidest; k += kWidest) {
    hn::Store(
        hn::MulAdd(e1, hn::Load(d, columns.grey + k), hn::Mul(e2, hn::Load(d, columns.q + k))), d,
        gradients + k);
  }
}

/// All of them are of one block. Points are in the order of pixels, so mostly they are.
HWY_INLINE bool areAlike(const std::uint16_t* blocks, std::size_t count) {
  int different = 0;
  for (std::size_t i = 1; i < count; ++i) different |= blocks[i] ^ blocks[0];
  return different == 0;
}

void sumBlocks(const ReferencePoints& points, const ResidualView& residuals,
               const Whitening& whitening, float* partial_sums) {
  const D d;
  constexpr std::size_t kSize = kUnknowns * kWidest;
  HWY_ALIGN float added[kSize];
  for (std::size_t i = 0; i < residuals.count; i += hn::Lanes(d)) {
    storeGradients(points, residuals, whitening, i, added);
    const std::uint16_t* blocks = points.block.data() + i;
    if (areAlike(blocks, hn::Lanes(d))) {
      float* sums = partial_sums + blocks[0] * kSize;
      for (std::size_t k = 0; k < kSize; k += kWidest) {
        hn::StoreU(hn::Add(hn::LoadU(d, sums + k), hn::Load(d, added + k)), d, sums + k);
      }
      continue;
    }
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      float* sums = partial_sums + blocks[lane] * kSize + lane;
      for (std::size_t k = 0; k < kSize; k += kWidest) sums[k] += added[k + lane];
    }
  }
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(sum);
HWY_EXPORT(sumBlocks);

void addVectorSums(AlignmentKernels& kernels) {
  kernels.sum = &HWY_DYNAMIC_DISPATCH(sum);
  kernels.sum_blocks = &HWY_DYNAMIC_DISPATCH(sumBlocks);
}

}  // namespace planecloud
#endif  // HWY_ONCE
