// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstddef>

#include "planecloud_slam/icap/match_sums.h"
#include "planecloud_slam/icap/plane_set.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/icap/match_sums_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMatchBlock = 16;  // of matches: the longest vectors there are
using MatchTag = hn::CappedTag<float, kMatchBlock>;
using MatchLanes = hn::Vec<MatchTag>;

/// A point or direction of every match.
struct MatchTriple {
  MatchLanes x, y, z;
};

MatchLanes dot(const MatchTriple& a, const MatchTriple& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

MatchTriple difference(const MatchTriple& a, const MatchTriple& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

MatchTriple scaled(const MatchTriple& a, MatchLanes factor) {
  return {hn::Mul(a.x, factor), hn::Mul(a.y, factor), hn::Mul(a.z, factor)};
}

MatchTriple cross(const MatchTriple& a, const MatchTriple& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

/// Some matches column by column.
struct MatchBlock {
  // clang-format off
  enum Column { kSourceCentroid = 0, kSourceNormal = 3, kTargetCentroid = 6, kTargetNormal = 9,
                kSourceDistance = 12, kTargetDistance, kSourceAngle, kTargetAngle, kThere,
                kColumns };
  // clang-format on
  std::array<std::array<float, kMatchBlock>, kColumns> columns{};

  void put(std::size_t i, const PatchMatch& match) {
    const auto triple = [&](std::size_t column, const Eigen::Vector3d& v) {
      for (std::size_t k = 0; k < 3; ++k) {
        columns[column + k][i] = static_cast<float>(v[static_cast<Eigen::Index>(k)]);
      }
    };
    triple(kSourceCentroid, match.source->centroid);
    triple(kSourceNormal, match.source->normal);
    triple(kTargetCentroid, match.target->centroid);
    triple(kTargetNormal, match.target->normal);
    columns[kSourceDistance][i] = static_cast<float>(match.source->distance_sigma);
    columns[kTargetDistance][i] = static_cast<float>(match.target->distance_sigma);
    columns[kSourceAngle][i] = static_cast<float>(match.source->normal_sigma);
    columns[kTargetAngle][i] = static_cast<float>(match.target->normal_sigma);
    columns[kThere][i] = 1.0F;
  }
  MatchLanes lanes(std::size_t column, std::size_t i) const {
    return hn::LoadU(MatchTag(), columns[column].data() + i);
  }
  MatchTriple triple(std::size_t column, std::size_t i) const {
    return {lanes(column, i), lanes(column + 1, i), lanes(column + 2, i)};
  }
};

/// MatchSums, lane by lane.
struct LaneSums {
  std::array<MatchLanes, 21> hessian, spread_along;
  std::array<MatchLanes, 6> gradient, spread_square, dyads, dyads_variance;
  std::array<MatchLanes, 3> spread_point;
  MatchLanes spread, weight, weight_variance, weighted_error, kernel_weight, squared_distance;

  LaneSums() {
    const MatchLanes zero = hn::Zero(MatchTag());
    hessian.fill(zero);
    spread_along.fill(zero);
    for (auto* six : {&gradient, &spread_square, &dyads, &dyads_variance}) six->fill(zero);
    spread_point.fill(zero);
    spread = weight = weight_variance = weighted_error = kernel_weight = squared_distance = zero;
  }
};

template <std::size_t Size>
HWY_INLINE void addSquare(const std::array<MatchLanes, Size>& v, MatchLanes weight,
                          std::array<MatchLanes, Size*(Size + 1) / 2>& sum) {
  std::size_t entry = 0;
  for (std::size_t row = 0; row < Size; ++row) {
    const MatchLanes weighted = hn::Mul(weight, v[row]);
    for (std::size_t column = row; column < Size; ++column, ++entry) {
      sum[entry] = hn::MulAdd(weighted, v[column], sum[entry]);
    }
  }
}

/// T_source_target and MatchWeighing in single precision.
struct MatchFrame {
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
  float distance_floor, normal_floor, inverse_width;

  MatchTriple turn(const MatchTriple& v) const {
    const MatchTag d;
    const auto row = [&](int r) {
      return dot({hn::Set(d, R(r, 0)), hn::Set(d, R(r, 1)), hn::Set(d, R(r, 2))}, v);
    };
    return {row(0), row(1), row(2)};
  }
  MatchTriple move(const MatchTriple& v) const {
    const MatchTag d;
    const MatchTriple turned = turn(v);
    return {hn::Add(turned.x, hn::Set(d, t.x())), hn::Add(turned.y, hn::Set(d, t.y())),
            hn::Add(turned.z, hn::Set(d, t.z()))};
  }
  MatchLanes kernel(MatchLanes squared) const {
    const MatchTag d;
    const MatchLanes one = hn::Set(d, 1.0F);
    const MatchLanes root =
        hn::Div(one, hn::MulAdd(squared, hn::Set(d, inverse_width * inverse_width), one));
    return hn::Mul(root, root);
  }
};

MatchLanes squareSum(MatchLanes a, MatchLanes b, float floor) {
  return hn::MulAdd(a, a, hn::MulAdd(b, b, hn::Set(MatchTag(), floor * floor)));
}

/// See Residual in match_sums.cpp.
struct LaneResiduals {
  MatchTriple normal, point, difference;
  MatchLanes distance, distance_variance, normal_variance;
};

LaneResiduals residualsOf(const MatchBlock& block, std::size_t i, const MatchFrame& frame) {
  const MatchTag d;
  const MatchTriple source_normal = block.triple(MatchBlock::kSourceNormal, i);
  const MatchTriple target_normal = frame.turn(block.triple(MatchBlock::kTargetNormal, i));
  const MatchLanes source_angle = block.lanes(MatchBlock::kSourceAngle, i);
  const MatchLanes target_angle = block.lanes(MatchBlock::kTargetAngle, i);
  const MatchLanes source_variance = hn::Mul(source_angle, source_angle);
  const MatchLanes target_variance = hn::Mul(target_angle, target_angle);
  const MatchLanes share = hn::Div(source_variance, hn::Add(source_variance, target_variance));
  LaneResiduals r;
  r.difference = difference(source_normal, target_normal);
  // share target + (1 - share) source
  const MatchTriple mean = difference(source_normal, scaled(r.difference, share));
  r.normal = scaled(mean, hn::Div(hn::Set(d, 1.0F), hn::Sqrt(dot(mean, mean))));
  r.point = block.triple(MatchBlock::kSourceCentroid, i);
  const MatchTriple offset =
      difference(r.point, frame.move(block.triple(MatchBlock::kTargetCentroid, i)));
  r.distance = dot(r.normal, offset);
  r.normal_variance =
      hn::MulAdd(share, target_variance, hn::Set(d, frame.normal_floor * frame.normal_floor));
  const MatchLanes lever =
      hn::Max(hn::Zero(d), hn::NegMulAdd(r.distance, r.distance, dot(offset, offset)));
  r.distance_variance =
      hn::MulAdd(lever, r.normal_variance,
                 squareSum(block.lanes(MatchBlock::kSourceDistance, i),
                           block.lanes(MatchBlock::kTargetDistance, i), frame.distance_floor));
  return r;
}

void addDistances(const LaneResiduals& r, MatchLanes weight, LaneSums& sums) {
  const MatchTriple moment = cross(r.point, r.normal);
  const std::array<MatchLanes, 6> jacobian{r.normal.x, r.normal.y, r.normal.z,
                                           moment.x,   moment.y,   moment.z};
  const MatchLanes spread = hn::Mul(weight, r.normal_variance);
  addSquare<6>(jacobian, weight, sums.hessian);
  addSquare<6>(jacobian, spread, sums.spread_along);
  const std::array<MatchLanes, 3> point{r.point.x, r.point.y, r.point.z};
  addSquare<3>(point, spread, sums.spread_square);
  const MatchLanes pull = hn::Mul(weight, r.distance);
  for (std::size_t k = 0; k < 6; ++k) {
    sums.gradient[k] = hn::MulAdd(pull, jacobian[k], sums.gradient[k]);
  }
  sums.spread = hn::Add(sums.spread, spread);
  for (std::size_t k = 0; k < 3; ++k) {
    sums.spread_point[k] = hn::MulAdd(spread, point[k], sums.spread_point[k]);
  }
}

void addNormals(const LaneResiduals& r, const MatchTriple& normal, MatchLanes weight,
                MatchLanes variance, LaneSums& sums) {
  const std::array<MatchLanes, 3> m{normal.x, normal.y, normal.z};
  const MatchLanes spread = hn::Mul(weight, variance);
  sums.weight = hn::Add(sums.weight, weight);
  sums.weight_variance = hn::Add(sums.weight_variance, spread);
  addSquare<3>(m, weight, sums.dyads);
  addSquare<3>(m, spread, sums.dyads_variance);
  const MatchTriple pull = scaled(cross(normal, r.difference), weight);
  sums.gradient[3] = hn::Add(sums.gradient[3], pull.x);
  sums.gradient[4] = hn::Add(sums.gradient[4], pull.y);
  sums.gradient[5] = hn::Add(sums.gradient[5], pull.z);
}

void addBlock(const MatchBlock& block, const MatchFrame& frame, LaneSums& sums) {
  for (std::size_t i = 0; i < kMatchBlock; i += hn::Lanes(MatchTag())) {
    const LaneResiduals r = residualsOf(block, i, frame);
    const MatchLanes there = block.lanes(MatchBlock::kThere, i);
    const MatchLanes square = hn::Mul(r.distance, r.distance);
    const MatchLanes squared = hn::Div(square, r.distance_variance);
    const MatchLanes weight = hn::Mul(there, frame.kernel(squared));
    const MatchLanes normal_variance =
        squareSum(block.lanes(MatchBlock::kSourceAngle, i),
                  block.lanes(MatchBlock::kTargetAngle, i), frame.normal_floor);
    const MatchLanes joint_weight =
        hn::Mul(weight, frame.kernel(hn::Div(dot(r.difference, r.difference), normal_variance)));
    addDistances(r, hn::Div(joint_weight, r.distance_variance), sums);
    addNormals(r, block.triple(MatchBlock::kSourceNormal, i),
               hn::Div(joint_weight, normal_variance), normal_variance, sums);
    sums.weighted_error = hn::MulAdd(weight, squared, sums.weighted_error);
    sums.kernel_weight = hn::Add(sums.kernel_weight, weight);
    sums.squared_distance = hn::MulAdd(there, square, sums.squared_distance);
  }
}

double total(MatchLanes lanes) {
  std::array<float, kMatchBlock> values{};
  hn::StoreU(lanes, MatchTag(), values.data());
  double sum = 0.0;
  for (std::size_t i = 0; i < hn::Lanes(MatchTag()); ++i) sum += static_cast<double>(values[i]);
  return sum;
}

template <std::size_t Size>
void totals(const std::array<MatchLanes, Size>& lanes, std::array<double, Size>& sums) {
  // Not by an algorithm of the standard library: that is compiled without these instructions and
  // would hand vectors over by another calling convention.
  for (std::size_t i = 0; i < Size; ++i) sums[i] = total(lanes[i]);
}

MatchSums totals(const LaneSums& lanes) {
  MatchSums sums;
  totals(lanes.hessian, sums.hessian);
  totals(lanes.spread_along, sums.spread_along);
  totals(lanes.gradient, sums.gradient);
  totals(lanes.spread_point, sums.spread_point);
  totals(lanes.spread_square, sums.spread_square);
  totals(lanes.dyads, sums.dyads);
  totals(lanes.dyads_variance, sums.dyads_variance);
  sums.spread = total(lanes.spread);
  sums.weight = total(lanes.weight);
  sums.weight_variance = total(lanes.weight_variance);
  sums.weighted_error = total(lanes.weighted_error);
  sums.kernel_weight = total(lanes.kernel_weight);
  sums.squared_distance = total(lanes.squared_distance);
  return sums;
}

MatchSums sumMatches(const std::vector<PatchMatch>& matches,
                     const Eigen::Isometry3d& T_source_target, const MatchWeighing& weighing) {
  const MatchFrame frame{
      T_source_target.linear().cast<float>(), T_source_target.translation().cast<float>(),
      static_cast<float>(weighing.distance_floor), static_cast<float>(weighing.normal_floor),
      static_cast<float>(1.0 / weighing.kernel_width)};
  LaneSums sums;
  MatchBlock block;
  for (std::size_t first = 0; first < matches.size(); first += kMatchBlock) {
    for (std::size_t i = 0; i < kMatchBlock; ++i) {
      // The first match fills the last block up and does not count there.
      const bool there = first + i < matches.size();
      block.put(i, matches[there ? first + i : 0]);
      if (!there) block.columns[MatchBlock::kThere][i] = 0.0F;
    }
    addBlock(block, frame, sums);
  }
  return totals(sums);
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(sumMatches);

MatchSums sumMatches(const std::vector<PatchMatch>& matches,
                     const Eigen::Isometry3d& T_source_target, const MatchWeighing& weighing) {
  return HWY_DYNAMIC_DISPATCH(sumMatches)(matches, T_source_target, weighing);
}

}  // namespace planecloud
#endif  // HWY_ONCE
