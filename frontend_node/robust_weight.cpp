// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/robust_weight.h"

#include <algorithm>
#include <cmath>

namespace planecloud {

double ResidualScale::logVolume() const { return std::log(sigma_grey) + std::log(sigma_q); }

Whitening makeWhitening(const ResidualScale& scale, double nu) {
  return {static_cast<float>(1.0 / scale.sigma_grey), static_cast<float>(1.0 / scale.sigma_q),
          static_cast<float>(scale.slope), static_cast<float>(nu)};
}

ScatterSums sumScatterScalar(const ResidualView& residuals, const Whitening& whitening) {
  ScatterSums sums;
  for (std::size_t i = 0; i < residuals.count; ++i) {
    const float grey = residuals.grey[i];
    const float q = residuals.q[i];
    const float e1 = (grey - whitening.slope * q) * whitening.inverse_grey;
    const float e2 = q * whitening.inverse_q;
    const double weight =
        residuals.seen[i] * (whitening.nu + 2.0F) / (whitening.nu + e1 * e1 + e2 * e2);
    sums.seen += residuals.seen[i];
    sums.grey_grey += weight * grey * grey;
    sums.grey_q += weight * grey * q;
    sums.q_q += weight * q * q;
  }
  return sums;
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
ScatterSums sumScatterVector(const ResidualView& residuals, const Whitening& whitening) {
  return sumScatterScalar(residuals, whitening);
}
#endif

ResidualScale reestimateScale(const ResidualView& residuals, const ResidualScale& previous,
                              const ScaleModel& model) {
  const ScatterSums sums =
      sumScatterVector(residuals, makeWhitening(previous, model.degrees_of_freedom));
  const double n = std::max(1.0, sums.seen);
  const double var_q = std::max(sums.q_q / n, model.min_sigma_q * model.min_sigma_q);
  ResidualScale scale;
  scale.slope = sums.grey_q / n / var_q;
  const double var_grey = sums.grey_grey / n - scale.slope * scale.slope * var_q;
  scale.sigma_q = std::sqrt(var_q);
  scale.sigma_grey = std::sqrt(std::max(var_grey, model.min_sigma_grey * model.min_sigma_grey));
  return scale;
}

}  // namespace planecloud
