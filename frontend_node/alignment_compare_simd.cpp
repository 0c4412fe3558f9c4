// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "planecloud_slam/frontend_node/alignment_kernel_simd.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/frontend_node/alignment_compare_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, ReferencePoints::kLanes>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;

constexpr std::size_t kWidest = ReferencePoints::kLanes;
constexpr std::size_t kChunk = 256;

/// Where the points of one chunk are seen.
struct ChunkWarp {
  HWY_ALIGN float fx[kChunk];  ///< between the columns, [0, 1)
  HWY_ALIGN float fy[kChunk];
  HWY_ALIGN float predicted[kChunk];  ///< inverse depth [1/m]
  HWY_ALIGN float inside[kChunk];     ///< 1: in the image and in front of it, else 0
  HWY_ALIGN std::int32_t at[kChunk];  ///< index of the upper left pixel
  HWY_ALIGN float upper[4 * kChunk];  ///< grey, q of the upper left pixel, then of the upper right
  HWY_ALIGN float lower[4 * kChunk];
};

void projectChunk(const ReferencePoints& points, std::size_t begin, std::size_t count,
                  const LevelCamera& camera, const WarpF& warp, ChunkWarp& out) {
  const D d;
  const DI di;
  const auto r = [&](int row, int column) { return hn::Set(d, warp.R(row, column)); };
  const V r00 = r(0, 0), r01 = r(0, 1), r02 = r(0, 2), r10 = r(1, 0), r11 = r(1, 1), r12 = r(1, 2),
          r20 = r(2, 0), r21 = r(2, 1), r22 = r(2, 2);
  const V t0 = hn::Set(d, warp.t(0)), t1 = hn::Set(d, warp.t(1)), t2 = hn::Set(d, warp.t(2));
  const V focal_x = hn::Set(d, camera.fx), focal_y = hn::Set(d, camera.fy);
  const V centre_x = hn::Set(d, camera.cx), centre_y = hn::Set(d, camera.cy);
  const V right = hn::Set(d, static_cast<float>(camera.width - 1));
  const V bottom = hn::Set(d, static_cast<float>(camera.height - 1));
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const auto width = hn::Set(di, camera.width);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const V u = hn::LoadU(d, points.u.data() + begin + k);
    const V v = hn::LoadU(d, points.v.data() + begin + k);
    const V q = hn::LoadU(d, points.q.data() + begin + k);
    const V px = hn::MulAdd(r00, u, hn::MulAdd(r01, v, hn::MulAdd(t0, q, r02)));
    const V py = hn::MulAdd(r10, u, hn::MulAdd(r11, v, hn::MulAdd(t1, q, r12)));
    const V pz = hn::MulAdd(r20, u, hn::MulAdd(r21, v, hn::MulAdd(t2, q, r22)));
    const V inverse_z = hn::Div(one, pz);
    const V x = hn::MulAdd(focal_x, hn::Mul(px, inverse_z), centre_x);
    const V y = hn::MulAdd(focal_y, hn::Mul(py, inverse_z), centre_y);
    const V predicted = hn::Mul(q, inverse_z);
    const auto inside = hn::And(hn::And(hn::And(hn::Ge(x, zero), hn::Lt(x, right)),
                                        hn::And(hn::Ge(y, zero), hn::Lt(y, bottom))),
                                hn::Gt(predicted, zero));
    const V safe_x = hn::IfThenElseZero(inside, x);
    const V safe_y = hn::IfThenElseZero(inside, y);
    const auto column = hn::ConvertTo(di, safe_x);
    const auto row = hn::ConvertTo(di, safe_y);
    hn::Store(hn::Sub(safe_x, hn::ConvertTo(d, column)), d, out.fx + k);
    hn::Store(hn::Sub(safe_y, hn::ConvertTo(d, row)), d, out.fy + k);
    hn::Store(predicted, d, out.predicted + k);
    hn::Store(hn::IfThenElseZero(inside, one), d, out.inside + k);
    hn::Store(hn::Add(hn::Mul(row, width), column), di, out.at + k);
  }
}

/// Two pixels side by side are one vector of four floats: cheaper to fetch than by gathers.
void fetchChunk(const RgbdLevel& current, std::size_t count, ChunkWarp& out) {
  static_assert(sizeof(GreyDepth) == 2 * sizeof(float));
  const hn::CappedTag<float, 4> d4;
  const auto* pixels = reinterpret_cast<const float*>(current.pixels.begin());
  const std::ptrdiff_t stride = 2 * std::ptrdiff_t{current.camera.width};
  for (std::size_t k = 0; k < count; ++k) {
    const float* from = pixels + 2 * std::ptrdiff_t{out.at[k]};
    for (std::size_t part = 0; part < 4; part += hn::Lanes(d4)) {
      hn::Store(hn::LoadU(d4, from + part), d4, out.upper + 4 * k + part);
      hn::Store(hn::LoadU(d4, from + stride + part), d4, out.lower + 4 * k + part);
    }
  }
}

HWY_INLINE V interpolate(V a, V b, V c, V e, V fx, V fy) {
  const V upper = hn::MulAdd(fx, hn::Sub(b, a), a);
  const V lower = hn::MulAdd(fx, hn::Sub(e, c), c);
  return hn::MulAdd(fy, hn::Sub(lower, upper), upper);
}

/// See the scalar sampleInverseDepth.
HWY_INLINE V sampleInverseDepth(V a, V b, V c, V e, V fx, V fy) {
  const D d;
  const V low = hn::Min(hn::Min(a, b), hn::Min(c, e));
  const V high = hn::Max(hn::Max(a, b), hn::Max(c, e));
  const V half = hn::Set(d, 0.5F);
  const auto left = hn::Lt(fx, half);
  const V nearest =
      hn::IfThenElse(hn::Lt(fy, half), hn::IfThenElse(left, a, b), hn::IfThenElse(left, c, e));
  const auto one_surface = hn::Gt(low, hn::Mul(hn::Set(d, 1.0F - kCellSpread), high));
  return hn::IfThenElse(one_surface, interpolate(a, b, c, e, fx, fy), nearest);
}

/// Counts of one comparison, one part a lane.
struct LaneCounts {
  HWY_ALIGN float in_image[kWidest] = {};
  HWY_ALIGN float agreeing[kWidest] = {};
  HWY_ALIGN float seen[kWidest] = {};
};

HWY_INLINE void count(V ones, float* counts) {
  const D d;
  hn::Store(hn::Add(hn::Load(d, counts), ones), d, counts);
}

void compareChunk(const ReferencePoints& points, std::size_t begin, std::size_t size,
                  const ChunkWarp& chunk, const WarpF& warp, Residuals& out, LaneCounts& counts) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const V inverse_gain = hn::Set(d, warp.inverse_gain), offset = hn::Set(d, warp.offset);
  for (std::size_t k = 0; k < size; k += hn::Lanes(d)) {
    V g0, q0, g1, q1, g2, q2, g3, q3;
    hn::LoadInterleaved4(d, chunk.upper + 4 * k, g0, q0, g1, q1);
    hn::LoadInterleaved4(d, chunk.lower + 4 * k, g2, q2, g3, q3);
    const V fx = hn::Load(d, chunk.fx + k), fy = hn::Load(d, chunk.fy + k);
    const V predicted = hn::Load(d, chunk.predicted + k);
    const V q = sampleInverseDepth(q0, q1, q2, q3, fx, fy);
    const auto valid = hn::And(hn::Gt(q, zero), hn::Gt(hn::Load(d, chunk.inside + k), zero));
    const V r_q = hn::Sub(q, predicted);
    const V deviation = hn::Abs(r_q);
    const auto agreeing =
        hn::And(valid, hn::Lt(deviation, hn::Mul(hn::Set(d, kAgreeing), predicted)));
    const V grey = interpolate(g0, g1, g2, g3, fx, fy);
    const auto seen = hn::And(hn::And(valid, hn::Lt(grey, hn::Set(d, kSaturated))),
                              hn::Le(deviation, hn::Mul(hn::Set(d, kNotOccluded), predicted)));
    const V r_grey = hn::MulSub(hn::Sub(grey, offset), inverse_gain,
                                hn::LoadU(d, points.grey.data() + begin + k));
    hn::StoreU(hn::IfThenElseZero(seen, r_grey), d, out.grey.data() + begin + k);
    hn::StoreU(hn::IfThenElseZero(seen, r_q), d, out.q.data() + begin + k);
    hn::StoreU(hn::IfThenElseZero(seen, one), d, out.seen.data() + begin + k);
    count(hn::IfThenElseZero(valid, one), counts.in_image);
    count(hn::IfThenElseZero(agreeing, one), counts.agreeing);
    count(hn::IfThenElseZero(seen, one), counts.seen);
  }
}

std::size_t total(const float* counts) {
  float sum = 0.0F;
  for (std::size_t lane = 0; lane < kWidest; ++lane) sum += counts[lane];
  return static_cast<std::size_t>(sum);
}

void compare(const ReferencePoints& points, const RgbdLevel& current, const WarpF& warp,
             Residuals& out) {
  ChunkWarp chunk;
  LaneCounts counts;
  const std::size_t padded = points.paddedCount();
  for (std::size_t begin = 0; begin < padded; begin += kChunk) {
    const std::size_t size = std::min(kChunk, padded - begin);
    projectChunk(points, begin, size, current.camera, warp, chunk);
    fetchChunk(current, size, chunk);
    compareChunk(points, begin, size, chunk, warp, out, counts);
  }
  out.in_image = total(counts.in_image);
  out.agreeing = total(counts.agreeing);
  out.seen_count = total(counts.seen);
}

const char* alignmentTarget() { return hwy::TargetName(HWY_TARGET); }

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(compare);
HWY_EXPORT(alignmentTarget);

const AlignmentKernels& vectorAlignmentKernels() {
  static const AlignmentKernels kernels = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    AlignmentKernels chosen{};
    chosen.name = HWY_DYNAMIC_DISPATCH(alignmentTarget)();
    chosen.compare = &HWY_DYNAMIC_DISPATCH(compare);
    addVectorSums(chosen);
    return chosen;
  }();
  return kernels;
}

}  // namespace planecloud
#endif  // HWY_ONCE
