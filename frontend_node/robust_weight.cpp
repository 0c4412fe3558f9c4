// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/robust_weight.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "planecloud_slam/frontend_node/tracking_reference.h"

namespace planecloud {
namespace {

using Lanes = Eigen::Array<float, ReferencePoints::kLanes, 1>;
using LanesMap = Eigen::Map<const Lanes>;

}  // namespace

double ResidualScale::logVolume() const { return std::log(sigma_grey) + std::log(sigma_q); }

ResidualScale reestimateScale(const ResidualView& residuals, const ResidualScale& previous,
                              const ScaleModel& model) {
  const auto inverse_grey = static_cast<float>(1.0 / previous.sigma_grey);
  const auto inverse_q = static_cast<float>(1.0 / previous.sigma_q);
  const auto slope = static_cast<float>(previous.slope);
  const auto nu_f = static_cast<float>(model.degrees_of_freedom);
  Lanes seen = Lanes::Zero(), gg = Lanes::Zero(), gq = Lanes::Zero(), qq = Lanes::Zero();
  for (std::size_t i = 0; i < residuals.count; i += ReferencePoints::kLanes) {
    const Lanes grey = LanesMap(residuals.grey + i);
    const Lanes q = LanesMap(residuals.q + i);
    const Lanes mask = LanesMap(residuals.seen + i);
    const Lanes e1 = (grey - slope * q) * inverse_grey;
    const Lanes e2 = q * inverse_q;
    const Lanes weight = mask * (nu_f + 2.0F) / (nu_f + e1 * e1 + e2 * e2);
    seen += mask;
    gg += weight * grey * grey;
    gq += weight * grey * q;
    qq += weight * q * q;
  }
  const double n = std::max(1.0, seen.cast<double>().sum());
  const double var_q = std::max(qq.cast<double>().sum() / n, model.min_sigma_q * model.min_sigma_q);
  ResidualScale scale;
  scale.slope = gq.cast<double>().sum() / n / var_q;
  const double var_grey = gg.cast<double>().sum() / n - scale.slope * scale.slope * var_q;
  scale.sigma_q = std::sqrt(var_q);
  scale.sigma_grey = std::sqrt(std::max(var_grey, model.min_sigma_grey * model.min_sigma_grey));
  return scale;
}

}  // namespace planecloud
