// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "planecloud_slam/frontend_node/robust_weight.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/frontend_node/robust_weight_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Residuals come in multiples of eight.
using ScatterD = hn::CappedTag<float, 8>;
/// Partial sums of this many residuals are kept in float.
constexpr std::size_t kScatterFlush = 4096;

ScatterSums sumScatter(const ResidualView& residuals, const Whitening& whitening) {
  const ScatterD d;
  const auto slope = hn::Set(d, whitening.slope), nu = hn::Set(d, whitening.nu);
  const auto inverse_grey = hn::Set(d, whitening.inverse_grey);
  const auto inverse_q = hn::Set(d, whitening.inverse_q);
  const auto dimension = hn::Set(d, whitening.nu + 2.0F);
  ScatterSums sums;
  for (std::size_t begin = 0; begin < residuals.count; begin += kScatterFlush) {
    const std::size_t end = std::min(begin + kScatterFlush, residuals.count);
    auto n = hn::Zero(d), gg = hn::Zero(d), gq = hn::Zero(d), qq = hn::Zero(d);
    for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
      const auto grey = hn::LoadU(d, residuals.grey + i);
      const auto q = hn::LoadU(d, residuals.q + i);
      const auto seen = hn::LoadU(d, residuals.seen + i);
      const auto e1 = hn::Mul(hn::NegMulAdd(slope, q, grey), inverse_grey);
      const auto e2 = hn::Mul(q, inverse_q);
      const auto weight =
          hn::Div(hn::Mul(seen, dimension), hn::MulAdd(e1, e1, hn::MulAdd(e2, e2, nu)));
      n = hn::Add(n, seen);
      gg = hn::MulAdd(hn::Mul(weight, grey), grey, gg);
      gq = hn::MulAdd(hn::Mul(weight, grey), q, gq);
      qq = hn::MulAdd(hn::Mul(weight, q), q, qq);
    }
    sums.seen += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, n)));
    sums.grey_grey += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, gg)));
    sums.grey_q += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, gq)));
    sums.q_q += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, qq)));
  }
  return sums;
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(sumScatter);

ScatterSums sumScatterVector(const ResidualView& residuals, const Whitening& whitening) {
  return HWY_DYNAMIC_DISPATCH(sumScatter)(residuals, whitening);
}

}  // namespace planecloud
#endif  // HWY_ONCE
