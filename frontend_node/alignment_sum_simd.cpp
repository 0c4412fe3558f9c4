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
/// Sums: 21 twist-twist, 6 twist-error, 6 twist-offset, 6 twist-gain, 5 of brightness, the error.
constexpr int kSums = 45;
/// Partial sums of this many points are kept in float.
constexpr std::size_t kFlush = 2048;

HWY_INLINE void accumulate(V a, V b, float*& sums) {
  const D d;
  hn::Store(hn::MulAdd(a, b, hn::Load(d, sums)), d, sums);
  sums += kWidest;
}

HWY_INLINE void accumulate2(V a, V b, V c, V e, float*& sums) {
  const D d;
  hn::Store(hn::MulAdd(a, b, hn::MulAdd(c, e, hn::Load(d, sums))), d, sums);
  sums += kWidest;
}

/// Jacobian rows `q a, (a x ray)` over the twist of a residual that changes by `q a . dp`.
HWY_INLINE void storeRow(V a1, V a2, V a3, V u, V v, V q, float* row) {
  const D d;
  hn::Store(hn::Mul(q, a1), d, row);
  hn::Store(hn::Mul(q, a2), d, row + kWidest);
  hn::Store(hn::Mul(q, a3), d, row + 2 * kWidest);
  hn::Store(hn::MulSub(v, a3, a2), d, row + 3 * kWidest);
  hn::Store(hn::NegMulAdd(u, a3, a1), d, row + 4 * kWidest);
  hn::Store(hn::MulSub(u, a2, hn::Mul(v, a1)), d, row + 5 * kWidest);
}

/// Whitened residuals of some points and their Jacobian: see scalar::whiten.
struct WhitenedPoints {
  HWY_ALIGN float row1[kTwist * kWidest];  ///< of e1 (grey) over the twist
  HWY_ALIGN float row2[kTwist * kWidest];  ///< of e2 (inverse depth) over the twist
  V offset, gain;                          ///< of e1 over brightness
  V e1, e2;
  V weight;  ///< 0 for points not seen

  HWY_INLINE WhitenedPoints(const ReferencePoints& points, const ResidualView& residuals,
                            const Whitening& whitening, std::size_t i) {
    const D d;
    const V u = hn::LoadU(d, points.u.data() + i), v = hn::LoadU(d, points.v.data() + i);
    const V q = hn::LoadU(d, points.q.data() + i);
    const V inverse_q = hn::Set(d, whitening.inverse_q);
    const V to_q = hn::Set(d, whitening.slope * whitening.inverse_grey / whitening.inverse_q);
    const V r_q = hn::LoadU(d, residuals.q + i);
    offset = hn::Set(d, whitening.inverse_grey);
    e2 = hn::Mul(r_q, inverse_q);
    e1 = hn::Mul(hn::NegMulAdd(hn::Set(d, whitening.slope), r_q, hn::LoadU(d, residuals.grey + i)),
                 offset);
    const V nu = hn::Set(d, whitening.nu);
    weight = hn::Div(hn::Mul(hn::LoadU(d, residuals.seen + i), hn::Add(nu, hn::Set(d, 2.0F))),
                     hn::Add(nu, square()));
    gain = hn::Mul(hn::Sub(hn::LoadU(d, points.grey.data() + i), hn::Set(d, kMiddleGrey)),
                   hn::Set(d, kInverseGreySpread * whitening.inverse_grey));
    const V b1 = hn::Mul(hn::LoadU(d, points.q_u.data() + i), inverse_q);
    const V b2 = hn::Mul(hn::LoadU(d, points.q_v.data() + i), inverse_q);
    const V b3 = hn::NegMulAdd(b2, v, hn::NegMulAdd(b1, u, hn::Mul(q, inverse_q)));
    const V i1 = hn::Mul(hn::LoadU(d, points.grey_u.data() + i), offset);
    const V i2 = hn::Mul(hn::LoadU(d, points.grey_v.data() + i), offset);
    const V i3 = hn::Neg(hn::MulAdd(i1, u, hn::Mul(i2, v)));
    storeRow(hn::NegMulAdd(to_q, b1, i1), hn::NegMulAdd(to_q, b2, i2), hn::NegMulAdd(to_q, b3, i3),
             u, v, q, row1);
    storeRow(b1, b2, b3, u, v, q, row2);
  }
  HWY_INLINE V square() const { return hn::MulAdd(e1, e1, hn::Mul(e2, e2)); }
};

HWY_INLINE void addPoints(const ReferencePoints& points, const ResidualView& residuals,
                          const Whitening& whitening, std::size_t i, float* sums) {
  const D d;
  const WhitenedPoints w(points, residuals, whitening, i);
  const V weighted_e1 = hn::Mul(w.weight, w.e1), weighted_e2 = hn::Mul(w.weight, w.e2);
  const V weighted_offset = hn::Mul(w.weight, w.offset), weighted_gain = hn::Mul(w.weight, w.gain);
  for (int r = 0; r < kTwist; ++r) {
    const V at1 = hn::Load(d, w.row1 + r * kWidest), at2 = hn::Load(d, w.row2 + r * kWidest);
    const V weighted1 = hn::Mul(w.weight, at1), weighted2 = hn::Mul(w.weight, at2);
    for (int c = r; c < kTwist; ++c) {
      accumulate2(weighted1, hn::Load(d, w.row1 + c * kWidest), weighted2,
                  hn::Load(d, w.row2 + c * kWidest), sums);
    }
    accumulate2(weighted_e1, at1, weighted_e2, at2, sums);
    accumulate(weighted_offset, at1, sums);
    accumulate(weighted_gain, at1, sums);
  }
  accumulate(weighted_offset, w.offset, sums);
  accumulate(weighted_offset, w.gain, sums);
  accumulate(weighted_gain, w.gain, sums);
  accumulate(weighted_e1, w.offset, sums);
  accumulate(weighted_e1, w.gain, sums);
  accumulate(w.weight, w.square(), sums);
}

/// Gradients of the points from `i` on, `kUnknowns` rows of lanes.
HWY_INLINE void storeGradients(const ReferencePoints& points, const ResidualView& residuals,
                               const Whitening& whitening, std::size_t i, float* gradients) {
  const D d;
  const WhitenedPoints w(points, residuals, whitening, i);
  const V e1 = hn::Mul(w.weight, w.e1), e2 = hn::Mul(w.weight, w.e2);
  for (int r = 0; r < kTwist; ++r) {
    const V at1 = hn::Load(d, w.row1 + r * kWidest), at2 = hn::Load(d, w.row2 + r * kWidest);
    hn::Store(hn::MulAdd(e1, at1, hn::Mul(e2, at2)), d, gradients + r * kWidest);
  }
  hn::Store(hn::Mul(e1, w.offset), d, gradients + kTwist * kWidest);
  hn::Store(hn::Mul(e1, w.gain), d, gradients + (kTwist + 1) * kWidest);
}

/// Adds the float sums to `equations` and clears them.
void flush(float* sums, NormalEquations& equations) {
  const auto next = [&sums] {
    double sum = 0.0;
    for (std::size_t lane = 0; lane < kWidest; ++lane) sum += static_cast<double>(sums[lane]);
    std::fill(sums, sums + kWidest, 0.0F);
    sums += kWidest;
    return sum;
  };
  for (int row = 0; row < kTwist; ++row) {
    for (int column = row; column < kTwist; ++column) equations.matrix(row, column) += next();
    equations.vector(row) += next();
    equations.matrix(row, 6) += next();
    equations.matrix(row, 7) += next();
  }
  equations.matrix(6, 6) += next();
  equations.matrix(6, 7) += next();
  equations.matrix(7, 7) += next();
  equations.vector(6) += next();
  equations.vector(7) += next();
  equations.error += next();
}

void sum(const ReferencePoints& points, const ResidualView& residuals, const Whitening& whitening,
         NormalEquations& equations) {
  HWY_ALIGN float sums[kSums * kWidest] = {};
  for (std::size_t begin = 0; begin < residuals.count; begin += kFlush) {
    const std::size_t end = std::min(begin + kFlush, residuals.count);
    for (std::size_t i = begin; i < end; i += hn::Lanes(D())) {
      addPoints(points, residuals, whitening, i, sums);
    }
    flush(sums, equations);
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
