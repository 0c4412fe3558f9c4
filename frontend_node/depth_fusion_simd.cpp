// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "planecloud_slam/frontend_node/depth_fusion_scalar.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/frontend_node/depth_fusion_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FusionD = hn::CappedTag<float, 8>;
using FusionDI = hn::RebindToSigned<FusionD>;
using FusionV = hn::Vec<FusionD>;

/// Row and motion as vectors. Rays of a row differ in u only.
struct VectorWarp {
  explicit VectorWarp(const FusionWarp& warp, float v) : camera(warp.camera) {
    for (int axis = 0; axis < 3; ++axis) {
      slope[axis] = warp.R(axis, 0);
      base[axis] = warp.R(axis, 1) * v + warp.R(axis, 2);
      shift[axis] = warp.t(axis);
    }
  }

  HWY_INLINE FusionV axis(int k, FusionV u, FusionV q) const {
    const FusionD d;
    return hn::MulAdd(hn::Set(d, slope[k]), u,
                      hn::MulAdd(hn::Set(d, shift[k]), q, hn::Set(d, base[k])));
  }

  /// Pixel and inverse depth at which (u, q) is seen; returns whether it is inside.
  HWY_INLINE auto see(FusionV u, FusionV q, FusionV& x, FusionV& y, FusionV& seen_q) const {
    const FusionD d;
    const FusionV inverse_z = hn::Div(hn::Set(d, 1.0F), axis(2, u, q));
    x = hn::MulAdd(hn::Set(d, static_cast<float>(camera.fx)), hn::Mul(axis(0, u, q), inverse_z),
                   hn::Set(d, static_cast<float>(camera.cx)));
    y = hn::MulAdd(hn::Set(d, static_cast<float>(camera.fy)), hn::Mul(axis(1, u, q), inverse_z),
                   hn::Set(d, static_cast<float>(camera.cy)));
    seen_q = hn::Mul(q, inverse_z);
    const FusionV zero = hn::Zero(d);
    const auto in_width =
        hn::And(hn::Ge(x, zero), hn::Lt(x, hn::Set(d, static_cast<float>(camera.width - 1))));
    const auto in_height =
        hn::And(hn::Ge(y, zero), hn::Lt(y, hn::Set(d, static_cast<float>(camera.height - 1))));
    return hn::And(hn::And(in_width, in_height), hn::Gt(seen_q, zero));
  }

  const CameraIntrinsics& camera;
  float slope[3];
  float base[3];
  float shift[3];
};

/// The four pixels around each position.
class Corners {
 public:
  HWY_INLINE void fetch(ImageView<float> depth, const std::int32_t* at, std::size_t lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float* upper = depth.row(0) + at[lane];
      std::memcpy(upper_ + 2 * lane, upper, 2 * sizeof(float));
      std::memcpy(lower_ + 2 * lane, upper + depth.stride(), 2 * sizeof(float));
    }
  }
  HWY_INLINE void upper(FusionV& left, FusionV& right) const {
    hn::LoadInterleaved2(FusionD(), upper_, left, right);
  }
  HWY_INLINE void lower(FusionV& left, FusionV& right) const {
    hn::LoadInterleaved2(FusionD(), lower_, left, right);
  }

 private:
  HWY_ALIGN float upper_[16];
  HWY_ALIGN float lower_[16];
};

void improve(const FusionWarp& warp, const FusionRow& row, ImageView<float> depth, float* mean,
             std::uint8_t* observations) {
  const FusionD d;
  const FusionDI di;
  const hn::Rebind<std::uint8_t, FusionD> bytes;
  const VectorWarp vector(warp, row.v);
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const FusionV zero = hn::Zero(d), one = hn::Set(d, 1.0F), gate = hn::Set(d, warp.gate);
  const auto stride = hn::Set(di, static_cast<std::int32_t>(depth.stride()));
  const auto most = hn::Set(di, std::int32_t{warp.max_observations});
  HWY_ALIGN std::int32_t at[8];
  Corners corners;
  int i = 0;
  for (; i + lanes <= row.count; i += lanes) {
    const FusionV q = hn::LoadU(d, mean + i);
    FusionV x, y, seen_q;
    const auto inside = vector.see(hn::LoadU(d, row.u + i), q, x, y, seen_q);
    if (hn::AllFalse(d, inside)) continue;
    x = hn::IfThenElseZero(inside, x);
    y = hn::IfThenElseZero(inside, y);
    const auto column = hn::ConvertTo(di, x);
    const auto line = hn::ConvertTo(di, y);
    const FusionV fx = hn::Sub(x, hn::ConvertTo(d, column));
    const FusionV fy = hn::Sub(y, hn::ConvertTo(d, line));
    hn::Store(hn::Add(hn::Mul(line, stride), column), di, at);
    corners.fetch(depth, at, static_cast<std::size_t>(lanes));
    FusionV a, b, c, e;
    corners.upper(a, b);
    corners.lower(c, e);
    const FusionV low = hn::Min(hn::Min(a, b), hn::Min(c, e));
    const FusionV high = hn::Max(hn::Max(a, b), hn::Max(c, e));
    const auto measured = hn::And(hn::And(hn::Gt(a, zero), hn::Gt(b, zero)),
                                  hn::And(hn::Gt(c, zero), hn::Gt(e, zero)));
    const FusionV predicted = hn::Div(one, hn::IfThenElse(inside, seen_q, one));
    const FusionV tolerance = hn::Mul(hn::Add(gate, gate), hn::Mul(predicted, predicted));
    const auto one_surface = hn::And(measured, hn::Lt(hn::Sub(high, low), tolerance));
    const FusionV top = hn::MulAdd(fx, hn::Sub(b, a), a);
    const FusionV bottom = hn::MulAdd(fx, hn::Sub(e, c), c);
    const FusionV z = hn::MulAdd(fy, hn::Sub(bottom, top), top);
    const FusionV deviation = hn::Mul(hn::Sub(predicted, z), hn::Mul(q, q));
    const auto seen = hn::PromoteTo(di, hn::LoadU(bytes, observations + i));
    const FusionV n = hn::ConvertTo(d, seen);
    const FusionV more = hn::Add(n, one);
    const auto agrees =
        hn::Le(hn::Mul(hn::Mul(deviation, deviation), n), hn::Mul(hn::Mul(gate, gate), more));
    const auto taken = hn::And(hn::And(inside, one_surface), agrees);
    hn::StoreU(hn::IfThenElse(taken, hn::Add(q, hn::Div(deviation, more)), q), d, mean + i);
    const auto counted = hn::Min(hn::Add(seen, hn::Set(di, 1)), most);
    hn::StoreU(hn::DemoteTo(bytes, hn::IfThenElse(hn::RebindMask(di, taken), counted, seen)), bytes,
               observations + i);
  }
  scalar::improve(warp, row, depth, mean, observations, i);
}

void project(const FusionWarp& warp, const FusionRow& row, const float* depth, int* at,
             float* inverse_depth) {
  const FusionD d;
  const FusionDI di;
  const VectorWarp vector(warp, row.v);
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const FusionV zero = hn::Zero(d), one = hn::Set(d, 1.0F), half = hn::Set(d, 0.5F);
  const FusionV infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto width = hn::Set(di, warp.camera.width);
  int i = 0;
  for (; i + lanes <= row.count; i += lanes) {
    const FusionV z = hn::LoadU(d, depth + i);
    const auto measured = hn::And(hn::Gt(z, zero), hn::Lt(z, infinity));
    FusionV x, y, seen_q;
    const auto inside =
        hn::And(measured, vector.see(hn::LoadU(d, row.u + i),
                                     hn::Div(one, hn::IfThenElse(measured, z, one)), x, y, seen_q));
    const auto column = hn::ConvertTo(di, hn::Add(hn::IfThenElseZero(inside, x), half));
    const auto line = hn::ConvertTo(di, hn::Add(hn::IfThenElseZero(inside, y), half));
    const auto index = hn::Add(hn::Mul(line, width), column);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di, inside), index, hn::Set(di, -1)), di, at + i);
    hn::StoreU(seen_q, d, inverse_depth + i);
  }
  scalar::project(warp, row, depth, at, inverse_depth, i);
}

const char* fusionTarget() { return hwy::TargetName(HWY_TARGET); }

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(improve);
HWY_EXPORT(project);
HWY_EXPORT(fusionTarget);

const FusionKernels& vectorFusionKernels() {
  static const FusionKernels kernels = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return FusionKernels{HWY_DYNAMIC_DISPATCH(fusionTarget)(), &HWY_DYNAMIC_DISPATCH(improve),
                         &HWY_DYNAMIC_DISPATCH(project)};
  }();
  return kernels;
}

}  // namespace planecloud
#endif  // HWY_ONCE
