// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "planecloud_slam/frontend_node/grey_motion_scalar.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/frontend_node/grey_motion_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using GreyD = hn::CappedTag<float, 8>;
using GreyDI = hn::RebindToSigned<GreyD>;
using GreyV = hn::Vec<GreyD>;

/// Pixels of a row that are looked up together.
constexpr int kGreyChunk = 64;

/// Where the pixels of one chunk come from.
struct GreySources {
  HWY_ALIGN float fx[kGreyChunk];  ///< between the columns, [0, 1)
  HWY_ALIGN float fy[kGreyChunk];
  HWY_ALIGN std::int32_t at[kGreyChunk];  ///< index of the upper left of the four pixels around
  HWY_ALIGN float upper[2 * kGreyChunk];  ///< of these, left and right
  HWY_ALIGN float lower[2 * kGreyChunk];
};

/// Pixels [first, first + count) of a row whose tangent is `v`.
void findSources(const GreyMotion& motion, float v, int first, int count, const GreyDepth* pixels,
                 GreySources& out) {
  const GreyD d;
  const GreyDI di;
  const LevelCamera& camera = motion.camera;
  const auto set = [&](float value) { return hn::Set(d, value); };
  GreyV slope[3], base[3], shift[3];
  for (int axis = 0; axis < 3; ++axis) {
    slope[axis] = set(motion.R(axis, 0));
    base[axis] = set(motion.R(axis, 1) * v + motion.R(axis, 2));
    shift[axis] = set(motion.t(axis));
  }
  const GreyV zero = hn::Zero(d);
  const GreyV last_x = set(scalar::lastPosition(camera.width));
  const GreyV last_y = set(scalar::lastPosition(camera.height));
  const auto width = hn::Set(di, camera.width);
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const GreyV column_in = hn::ConvertTo(d, hn::Iota(di, first + i));
    const GreyV u = hn::Mul(hn::Sub(column_in, set(camera.cx)), set(1.0F / camera.fx));
    GreyV grey, q;
    hn::LoadInterleaved2(d, &pixels[i].grey, grey, q);
    const auto along = [&](int axis) {
      return hn::MulAdd(slope[axis], u, hn::MulAdd(shift[axis], q, base[axis]));
    };
    const GreyV inverse_z = hn::Div(set(1.0F), hn::Max(along(2), set(1e-3F)));
    const GreyV x = hn::MulAdd(set(camera.fx), hn::Mul(along(0), inverse_z), set(camera.cx));
    const GreyV y = hn::MulAdd(set(camera.fy), hn::Mul(along(1), inverse_z), set(camera.cy));
    const GreyV inside_x = hn::Min(hn::Max(x, zero), last_x);
    const GreyV inside_y = hn::Min(hn::Max(y, zero), last_y);
    const auto column = hn::ConvertTo(di, inside_x);
    const auto row = hn::ConvertTo(di, inside_y);
    hn::Store(hn::Sub(inside_x, hn::ConvertTo(d, column)), d, out.fx + i);
    hn::Store(hn::Sub(inside_y, hn::ConvertTo(d, row)), d, out.fy + i);
    hn::Store(hn::Add(hn::Mul(row, width), column), di, out.at + i);
  }
}

void fetchSources(ImageView<float> grey, int count, GreySources& out) {
  for (int i = 0; i < count; ++i) {
    const float* upper = grey.row(0) + out.at[i];
    std::memcpy(out.upper + 2 * i, upper, 2 * sizeof(float));
    std::memcpy(out.lower + 2 * i, upper + grey.stride(), 2 * sizeof(float));
  }
}

void blendSources(const GreySources& sources, int count, GreyDepth* pixels) {
  const GreyD d;
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    GreyV a, b, c, e, grey, q;
    hn::LoadInterleaved2(d, sources.upper + 2 * i, a, b);
    hn::LoadInterleaved2(d, sources.lower + 2 * i, c, e);
    hn::LoadInterleaved2(d, &pixels[i].grey, grey, q);
    const GreyV fx = hn::Load(d, sources.fx + i);
    const GreyV top = hn::MulAdd(fx, hn::Sub(b, a), a);
    const GreyV bottom = hn::MulAdd(fx, hn::Sub(e, c), c);
    grey = hn::MulAdd(hn::Load(d, sources.fy + i), hn::Sub(bottom, top), top);
    hn::StoreInterleaved2(grey, q, d, &pixels[i].grey);
  }
}

void moveGreyRow(const GreyMotion& motion, ImageView<float> grey, int y, GreyDepth* pixels) {
  const auto lanes = static_cast<int>(hn::Lanes(GreyD()));
  const int whole = motion.camera.width / lanes * lanes;
  const float v = (static_cast<float>(y) - motion.camera.cy) / motion.camera.fy;
  GreySources sources;
  for (int first = 0; first < whole; first += kGreyChunk) {
    const int count = whole - first < kGreyChunk ? whole - first : kGreyChunk;
    findSources(motion, v, first, count, pixels + first, sources);
    fetchSources(grey, count, sources);
    blendSources(sources, count, pixels + first);
  }
  scalar::moveGreyRow(motion, grey, y, whole, pixels);
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(moveGreyRow);

MoveGreyRow vectorMoveGreyRow() {
  static const MoveGreyRow kernel = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return &HWY_DYNAMIC_DISPATCH(moveGreyRow);
  }();
  return kernel;
}

}  // namespace planecloud
#endif  // HWY_ONCE
