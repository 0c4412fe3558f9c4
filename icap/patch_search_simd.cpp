// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdint>
#include <limits>

#include "planecloud_slam/icap/patch_search.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/icap/patch_search_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, PatchColumns::kPadding>;
using Lanes = hn::Vec<Tag>;

/// What the search has found so far, lane by lane.
struct Nearest {
  Lanes cost;
  Lanes position;
};

/// The query spread over all lanes.
struct SpreadQuery {
  Lanes cx, cy, cz, nx, ny, nz, radius, max_surface, min_cosine, normal_weight;
};

SpreadQuery spread(const PatchQuery& query) {
  const Tag d;
  return {hn::Set(d, query.centroid.x()), hn::Set(d, query.centroid.y()),
          hn::Set(d, query.centroid.z()), hn::Set(d, query.normal.x()),
          hn::Set(d, query.normal.y()),   hn::Set(d, query.normal.z()),
          hn::Set(d, query.radius),       hn::Set(d, query.max_squared_distance),
          hn::Set(d, query.min_cosine),   hn::Set(d, query.squared_normal_length)};
}

void compare(const PatchColumns& patches, std::size_t i, const SpreadQuery& query,
             Nearest& nearest) {
  const Tag d;
  const Lanes nx = hn::LoadU(d, patches.normal_x.data() + i);
  const Lanes ny = hn::LoadU(d, patches.normal_y.data() + i);
  const Lanes nz = hn::LoadU(d, patches.normal_z.data() + i);
  const Lanes ox = hn::Sub(query.cx, hn::LoadU(d, patches.centroid_x.data() + i));
  const Lanes oy = hn::Sub(query.cy, hn::LoadU(d, patches.centroid_y.data() + i));
  const Lanes oz = hn::Sub(query.cz, hn::LoadU(d, patches.centroid_z.data() + i));
  const Lanes cosine = hn::MulAdd(nx, query.nx, hn::MulAdd(ny, query.ny, hn::Mul(nz, query.nz)));
  const Lanes distance = hn::MulAdd(nx, ox, hn::MulAdd(ny, oy, hn::Mul(nz, oz)));
  const Lanes squared = hn::MulAdd(ox, ox, hn::MulAdd(oy, oy, hn::Mul(oz, oz)));
  const Lanes zero = hn::Zero(d);
  const Lanes in_plane = hn::Sqrt(hn::Max(zero, hn::NegMulAdd(distance, distance, squared)));
  const Lanes reach = hn::Add(query.radius, hn::LoadU(d, patches.radius.data() + i));
  const Lanes gap = hn::Max(zero, hn::Sub(in_plane, reach));
  const Lanes surface = hn::MulAdd(distance, distance, hn::Mul(gap, gap));
  const Lanes two = hn::Set(d, 2.0F);
  const Lanes cost = hn::MulAdd(query.normal_weight, hn::NegMulAdd(two, cosine, two), surface);
  const auto within = hn::And(hn::Le(surface, query.max_surface), hn::Ge(cosine, query.min_cosine));
  const auto better = hn::And(within, hn::Lt(cost, nearest.cost));
  nearest.cost = hn::IfThenElse(better, cost, nearest.cost);
  // Positions are far below 2^24, so floats hold them exactly.
  nearest.position = hn::IfThenElse(better, hn::Iota(d, static_cast<float>(i)), nearest.position);
}

int nearestPatch(const PatchColumns& patches, const PatchQuery& query) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  const SpreadQuery wide = spread(query);
  Nearest nearest{hn::Set(d, std::numeric_limits<float>::max()), hn::Set(d, -1.0F)};
  for (std::size_t i = 0; i < patches.size; i += lanes) compare(patches, i, wide, nearest);
  std::array<float, PatchColumns::kPadding> costs;
  std::array<float, PatchColumns::kPadding> positions;
  hn::StoreU(nearest.cost, d, costs.data());
  hn::StoreU(nearest.position, d, positions.data());
  std::size_t best = 0;
  for (std::size_t i = 1; i < lanes; ++i) {
    const bool first = costs[i] == costs[best] && positions[i] < positions[best];
    if (costs[i] < costs[best] || first) best = i;
  }
  return static_cast<int>(positions[best]);
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(nearestPatch);

int nearestPatch(const PatchColumns& patches, const PatchQuery& query) {
  return HWY_DYNAMIC_DISPATCH(nearestPatch)(patches, query);
}

}  // namespace planecloud
#endif  // HWY_ONCE
