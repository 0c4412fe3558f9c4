// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/pyramid_kernels_scalar.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/frontend_node/pyramid_kernels_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using PyramidD = hn::CappedTag<float, 8>;
using PyramidV = hn::Vec<PyramidD>;

/// Four vectors of pixels that become one.
struct Four {
  PyramidV a, b, c, e;

  HWY_INLINE PyramidV largest() const { return hn::Max(hn::Max(a, b), hn::Max(c, e)); }
};

/// Sums and counts those of four values that are of the nearest surface.
class SurfaceMean {
 public:
  HWY_INLINE SurfaceMean() : sum_(hn::Zero(PyramidD())), count_(hn::Zero(PyramidD())) {}
  template <class M>
  HWY_INLINE void add(PyramidV value, M belongs) {
    const PyramidD d;
    sum_ = hn::Add(sum_, hn::IfThenElseZero(belongs, value));
    count_ = hn::Add(count_, hn::IfThenElseZero(belongs, hn::Set(d, 1.0F)));
  }
  HWY_INLINE PyramidV ratio(bool inverse) const {
    const PyramidD d;
    const auto any = hn::Gt(count_, hn::Zero(d));
    const PyramidV sum = hn::IfThenElse(any, sum_, hn::Set(d, 1.0F));
    const PyramidV count = hn::IfThenElse(any, count_, hn::Set(d, 1.0F));
    return hn::IfThenElseZero(any, inverse ? hn::Div(count, sum) : hn::Div(sum, count));
  }

 private:
  PyramidV sum_;
  PyramidV count_;
};

HWY_INLINE PyramidV mergeDepths(const Four& z) {
  const PyramidD d;
  const PyramidV zero = hn::Zero(d);
  PyramidV near = z.largest();
  for (const PyramidV depth : {z.a, z.b, z.c, z.e}) {
    near = hn::IfThenElse(hn::Gt(depth, zero), hn::Min(near, depth), near);
  }
  const PyramidV limit = hn::Mul(hn::Set(d, scalar::kDepthSpread), near);
  SurfaceMean mean;
  for (const PyramidV depth : {z.a, z.b, z.c, z.e}) {
    mean.add(depth, hn::And(hn::Gt(depth, zero), hn::Lt(hn::Sub(depth, near), limit)));
  }
  return mean.ratio(true);
}

HWY_INLINE PyramidV mergeInverseDepths(const Four& q) {
  const PyramidD d;
  const PyramidV near = q.largest();
  const PyramidV limit = hn::Mul(hn::Set(d, scalar::kInverseDepthSpread), near);
  SurfaceMean mean;
  for (const PyramidV inverse_depth : {q.a, q.b, q.c, q.e}) {
    mean.add(inverse_depth, hn::Lt(hn::Sub(near, inverse_depth), limit));
  }
  return mean.ratio(false);
}

/// Neighbouring grey values of a row, added.
HWY_INLINE auto addPairs(const std::uint8_t* row) {
  const hn::Rebind<std::uint8_t, PyramidD> bytes;
  const hn::Rebind<std::int16_t, PyramidD> words;
  hn::Vec<decltype(bytes)> even, odd;
  hn::LoadInterleaved2(bytes, row, even, odd);
  return hn::Add(hn::PromoteTo(words, even), hn::PromoteTo(words, odd));
}

void halveGrey(const GreyRows& rows, int count, float* made) {
  const PyramidD d;
  const hn::RebindToSigned<PyramidD> di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto sum = hn::Add(addPairs(rows.upper + 2 * i), addPairs(rows.lower + 2 * i));
    const PyramidV grey = hn::ConvertTo(d, hn::PromoteTo(di, sum));
    hn::StoreU(hn::Mul(grey, hn::Set(d, 0.25F)), d, made + i);
  }
  scalar::halveGrey(rows, i, count, made);
}

void halveDepth(const DepthRows& rows, const DepthRange& range, int count, GreyDepth* made) {
  const PyramidD d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto usable = [&](PyramidV z) {
    return hn::IfThenElseZero(
        hn::And(hn::Ge(z, hn::Set(d, range.least)), hn::Le(z, hn::Set(d, range.most))), z);
  };
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    Four z;
    hn::LoadInterleaved2(d, rows.upper + 2 * i, z.a, z.b);
    hn::LoadInterleaved2(d, rows.lower + 2 * i, z.c, z.e);
    z = {usable(z.a), usable(z.b), usable(z.c), usable(z.e)};
    hn::StoreInterleaved2(hn::LoadU(d, rows.made_grey + i), mergeDepths(z), d, &made[i].grey);
  }
  scalar::halveDepth(rows, range, i, count, made);
}

void halveLevel(const GreyDepth* upper, const GreyDepth* lower, int count, GreyDepth* made) {
  const PyramidD d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    Four grey, q;
    hn::LoadInterleaved4(d, &upper[2 * i].grey, grey.a, q.a, grey.b, q.b);
    hn::LoadInterleaved4(d, &lower[2 * i].grey, grey.c, q.c, grey.e, q.e);
    const PyramidV sum = hn::Add(hn::Add(hn::Add(grey.a, grey.b), grey.c), grey.e);
    hn::StoreInterleaved2(hn::Mul(hn::Set(d, 0.25F), sum), mergeInverseDepths(q), d, &made[i].grey);
  }
  scalar::halveLevel(upper, lower, i, count, made);
}

PyramidKernels pyramidKernels() {
  return {hwy::TargetName(HWY_TARGET), &halveGrey, &halveDepth, &halveLevel};
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(pyramidKernels);

const PyramidKernels& vectorPyramidKernels() {
  static const PyramidKernels kernels = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return HWY_DYNAMIC_DISPATCH(pyramidKernels)();
  }();
  return kernels;
}

}  // namespace planecloud
#endif  // HWY_ONCE
