// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/view_search_simd.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/icap/view_search_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using ViewTag = hn::CappedTag<float, PatchColumns::kPadding>;
using ViewIntTag = hn::RebindToSigned<ViewTag>;
using ViewLanes = hn::Vec<ViewTag>;
using ViewInts = hn::Vec<ViewIntTag>;
using ViewMask = hn::Mask<ViewTag>;

struct Triple {
  ViewLanes x, y, z;
};

ViewLanes dot(const Triple& a, const Triple& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

/// Patches where the motion puts them.
struct MovedLanes {
  Triple centroid, normal;
};

MovedLanes move(const MovedPatches& patches, std::size_t i) {
  const ViewTag d;
  const PatchColumns& p = patches.patches;
  const Eigen::Matrix3f& R = patches.R_view_patch;
  const Triple c{hn::LoadU(d, p.centroid_x.data() + i), hn::LoadU(d, p.centroid_y.data() + i),
                 hn::LoadU(d, p.centroid_z.data() + i)};
  const Triple n{hn::LoadU(d, p.normal_x.data() + i), hn::LoadU(d, p.normal_y.data() + i),
                 hn::LoadU(d, p.normal_z.data() + i)};
  const auto row = [&](int r, const Triple& v) {
    return dot({hn::Set(d, R(r, 0)), hn::Set(d, R(r, 1)), hn::Set(d, R(r, 2))}, v);
  };
  const Eigen::Vector3f& t = patches.t_view_patch;
  return {{hn::Add(row(0, c), hn::Set(d, t.x())), hn::Add(row(1, c), hn::Set(d, t.y())),
           hn::Add(row(2, c), hn::Set(d, t.z()))},
          {row(0, n), row(1, n), row(2, n)}};
}

/// A view spread over all lanes.
struct SpreadView {
  const TileView& view;
  ViewLanes fx, fy, cx, cy, width, height;
  ViewInts columns;
};

SpreadView spread(const TileView& view) {
  const ViewTag d;
  const CameraIntrinsics& k = view.camera;
  return {view,
          hn::Set(d, static_cast<float>(k.fx)),
          hn::Set(d, static_cast<float>(k.fy)),
          hn::Set(d, static_cast<float>(k.cx)),
          hn::Set(d, static_cast<float>(k.cy)),
          hn::Set(d, static_cast<float>(k.width)),
          hn::Set(d, static_cast<float>(k.height)),
          hn::Set(ViewIntTag(), view.cells.width())};
}

/// Tiles at image positions; kNotInView outside.
ViewInts tilesAt(const SpreadView& wide, ViewLanes x, ViewLanes y) {
  const ViewTag d;
  const ViewIntTag di;
  const ViewLanes half = hn::Set(d, 0.5F);
  const ViewLanes zero = hn::Zero(d);
  const ViewLanes rounded_x = hn::Floor(hn::Add(x, half));
  const ViewLanes rounded_y = hn::Floor(hn::Add(y, half));
  const ViewMask inside =
      hn::And(hn::And(hn::Ge(rounded_x, zero), hn::Ge(rounded_y, zero)),
              hn::And(hn::Lt(rounded_x, wide.width), hn::Lt(rounded_y, wide.height)));
  const ViewInts column = hn::ShiftRight<TileView::kCellShift>(
      hn::ConvertTo(di, hn::IfThenElseZero(inside, rounded_x)));
  const ViewInts row = hn::ShiftRight<TileView::kCellShift>(
      hn::ConvertTo(di, hn::IfThenElseZero(inside, rounded_y)));
  const ViewInts cell = hn::Add(column, hn::Mul(row, wide.columns));
  const ViewInts tiles = hn::GatherIndex(di, &wide.view.cells(0, 0), cell);
  return hn::IfThenElse(hn::RebindMask(di, inside), tiles, hn::Set(di, SeenTiles::kNotInView));
}

struct PlaneLanes {
  Triple normal;
  ViewLanes d;
};

/// Planes of tiles; of any tile where there is none.
PlaneLanes planesOf(const TileView& view, ViewInts tiles) {
  const ViewTag d;
  const ViewInts index = hn::Max(tiles, hn::Zero(ViewIntTag()));
  return {{hn::GatherIndex(d, view.normal_x.data(), index),
           hn::GatherIndex(d, view.normal_y.data(), index),
           hn::GatherIndex(d, view.normal_z.data(), index)},
          hn::GatherIndex(d, view.d.data(), index)};
}

ViewMask someTile(ViewInts tiles) {
  return hn::RebindMask(ViewTag(), hn::Gt(tiles, hn::Set(ViewIntTag(), -1)));
}

/// See bestTile in view_search.cpp.
ViewInts bestOf(const SpreadView& wide, const MovedLanes& patch, const ViewGates& gates) {
  using namespace view_search;
  const ViewTag d;
  const ViewLanes z = hn::Max(patch.centroid.z, hn::Set(d, kNearestDepth));
  const ViewMask fit = hn::And(hn::Ge(patch.centroid.z, hn::Set(d, kNearestDepth)),
                               hn::Lt(dot(patch.normal, patch.centroid), hn::Zero(d)));
  const ViewLanes inverse_z = hn::Div(hn::Set(d, 1.0F), z);
  const ViewLanes x = hn::MulAdd(hn::Mul(wide.fx, patch.centroid.x), inverse_z, wide.cx);
  const ViewLanes y = hn::MulAdd(hn::Mul(wide.fy, patch.centroid.y), inverse_z, wide.cy);
  const ViewLanes gate = hn::Set(d, gates.distance);
  const ViewLanes pixels_a_metre = hn::Mul(wide.fx, inverse_z);
  const ViewLanes stride =
      hn::Min(hn::Max(hn::Mul(hn::Mul(hn::Set(d, kStrideOfGate), gate), pixels_a_metre),
                      hn::Set(d, kShortestStride)),
              hn::Set(d, kLongestStride));
  const ViewLanes gap = hn::Div(stride, pixels_a_metre);
  const ViewLanes two = hn::Set(d, 2.0F);
  ViewLanes best_cost = hn::Set(d, kNoCost);
  ViewInts best = hn::Set(ViewIntTag(), -1);
  for (int place = 0; place < kPlaces; ++place) {
    const ViewInts tiles = tilesAt(wide, hn::MulAdd(stride, hn::Set(d, kPlaceX[place]), x),
                                   hn::MulAdd(stride, hn::Set(d, kPlaceY[place]), y));
    const PlaneLanes plane = planesOf(wide.view, tiles);
    const ViewLanes cosine = dot(plane.normal, patch.normal);
    const ViewLanes distance = hn::Add(dot(plane.normal, patch.centroid), plane.d);
    const ViewMask within = hn::And(
        hn::And(fit, someTile(tiles)),
        hn::And(hn::Ge(cosine, hn::Set(d, gates.min_cosine)), hn::Le(hn::Abs(distance), gate)));
    const ViewLanes away = place == 0 ? hn::Zero(d) : hn::Mul(gap, gap);
    const ViewLanes cost =
        hn::MulAdd(hn::Set(d, gates.squared_normal_length), hn::NegMulAdd(two, cosine, two),
                   hn::MulAdd(distance, distance, away));
    const ViewMask better = hn::And(within, hn::Lt(cost, best_cost));
    best_cost = hn::IfThenElse(better, cost, best_cost);
    best = hn::IfThenElse(hn::RebindMask(ViewIntTag(), better), tiles, best);
  }
  return best;
}

std::vector<std::int32_t> bestTiles(const TileView& view, const MovedPatches& patches,
                                    const ViewGates& gates) {
  const ViewIntTag di;
  const SpreadView wide = spread(view);
  std::vector<std::int32_t> tiles(patches.patches.size);
  for (std::size_t i = 0; i < patches.count; i += hn::Lanes(di)) {
    hn::StoreU(bestOf(wide, move(patches, i), gates), di, tiles.data() + i);
  }
  tiles.resize(patches.count);
  return tiles;
}

SeenTiles lookUpTiles(const TileView& view, const MovedPatches& patches) {
  const ViewTag d;
  const ViewIntTag di;
  const SpreadView wide = spread(view);
  const ViewLanes zero = hn::Zero(d);
  SeenTiles seen(patches.patches.size);
  for (std::size_t i = 0; i < patches.count; i += hn::Lanes(d)) {
    const MovedLanes patch = move(patches, i);
    const ViewLanes z = patch.centroid.z;
    const ViewMask fit = hn::And(hn::Gt(z, zero), hn::Lt(dot(patch.normal, patch.centroid), zero));
    const ViewLanes inverse_z = hn::Div(hn::Set(d, 1.0F), hn::IfThenElse(fit, z, hn::Set(d, 1.0F)));
    const ViewInts tiles =
        tilesAt(wide, hn::MulAdd(hn::Mul(wide.fx, patch.centroid.x), inverse_z, wide.cx),
                hn::MulAdd(hn::Mul(wide.fy, patch.centroid.y), inverse_z, wide.cy));
    const PlaneLanes plane = planesOf(view, tiles);
    const ViewLanes slope = hn::Neg(dot(plane.normal, patch.centroid));
    const ViewMask met = hn::Gt(slope, zero);
    const ViewLanes met_depth = hn::Div(hn::Mul(plane.d, z), hn::IfThenElse(met, slope, z));
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di, fit), tiles, hn::Set(di, SeenTiles::kNotInView)),
               di, seen.tiles.data() + i);
    hn::StoreU(z, d, seen.depth.data() + i);
    hn::StoreU(hn::IfThenElse(met, met_depth, z), d, seen.seen_depth.data() + i);
    hn::StoreU(dot(plane.normal, patch.normal), d, seen.cosine.data() + i);
  }
  return seen;
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(bestTiles);
HWY_EXPORT(lookUpTiles);

std::vector<std::int32_t> bestTilesVector(const TileView& view, const MovedPatches& patches,
                                          const ViewGates& gates) {
  return HWY_DYNAMIC_DISPATCH(bestTiles)(view, patches, gates);
}

SeenTiles lookUpTilesVector(const TileView& view, const MovedPatches& patches) {
  return HWY_DYNAMIC_DISPATCH(lookUpTiles)(view, patches);
}

}  // namespace planecloud
#endif  // HWY_ONCE
