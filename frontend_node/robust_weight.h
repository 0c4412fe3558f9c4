// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace planecloud {

/// The scale matrix of a bivariate t-distribution of (grey, inverse depth) residuals, held as the
/// whitening `e1 = (r_grey - slope r_q) / sigma_grey`, `e2 = r_q / sigma_q`, so that
/// `r^T Sigma^-1 r = e1^2 + e2^2`.
struct ResidualScale {
  double sigma_grey = 0.0;  ///< of grey, given the inverse depth residual [grey levels]
  double sigma_q = 0.0;     ///< of inverse depth [1/m]
  double slope = 0.0;       ///< regression of grey on inverse depth residuals [grey levels m]

  /// Half the log of the determinant of Sigma.
  [[nodiscard]] double logVolume() const;
};

/// Residuals of one image pair; `seen` is 1 where both are measured, else 0 (residuals then 0).
struct ResidualView {
  const float* grey = nullptr;
  const float* q = nullptr;  ///< [1/m]
  const float* seen = nullptr;
  std::size_t count = 0;  ///< multiple of `ReferencePoints::kLanes`
};

/// What is known of the residuals beforehand.
struct ScaleModel {
  double degrees_of_freedom = 5.0;  ///< nu of the t-distribution
  double min_sigma_grey = 0.3;      ///< [grey levels]
  double min_sigma_q = 0.03;        ///< [1/m]
};

/// `sum w r r^T` over the residuals seen, and their number.
struct ScatterSums {
  double seen = 0.0;
  double grey_grey = 0.0;
  double grey_q = 0.0;
  double q_q = 0.0;
};

/// A scale as the loops use it.
struct Whitening {
  float inverse_grey;
  float inverse_q;
  float slope;
  float nu;  ///< degrees of freedom of the t-distribution
};
[[nodiscard]] Whitening makeWhitening(const ResidualScale& scale, double nu);

/// With t weights `w = (nu + 2) / (nu + r^T Sigma^-1 r)`; two implementations that agree to
/// rounding.
[[nodiscard]] ScatterSums sumScatterScalar(const ResidualView& residuals,
                                           const Whitening& whitening);
[[nodiscard]] ScatterSums sumScatterVector(const ResidualView& residuals,
                                           const Whitening& whitening);

/// One step of the maximum-likelihood scale of a bivariate t-distribution: `Sigma = mean(w r r^T)`,
/// `w = (nu + 2) / (nu + r^T Sigma^-1 r)` with the Sigma of `previous` in the weights (Kerl 2013b
/// sec. III-C; 2 is the residuals' dimension, where the paper prints 1: that is the weight of a
/// single residual).
[[nodiscard]] ResidualScale reestimateScale(const ResidualView& residuals,
                                            const ResidualScale& previous, const ScaleModel& model);

}  // namespace planecloud
