// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/icap.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "planecloud_slam/icap/icap_paper.h"
#include "planecloud_slam/icap/robust_alignment.h"
#include "planecloud_slam/icap/visibility.h"

namespace planecloud {
namespace {

constexpr double kRestlessStep = 2e-2;  // a last step beyond has not settled at all [m, rad]

/// Information in the observed directions: correlated residuals count less, the unobserved part is
/// marginalised out, and what does not average out bounds it from above.
Matrix6d calibratedInformation(const AlignmentProgress& progress, const IcapOptions& options) {
  const Eigen::Matrix<double, 6, Eigen::Dynamic>& seen = progress.observability.observed;
  const Eigen::Matrix<double, 6, Eigen::Dynamic>& dark = progress.observability.unobserved;
  if (seen.cols() == 0) return Matrix6d::Zero();
  const Matrix6d& hessian = progress.system.hessian;
  Eigen::MatrixXd reduced = seen.transpose() * hessian * seen;
  if (dark.cols() > 0) {
    const Eigen::MatrixXd cross = seen.transpose() * hessian * dark;
    reduced -= cross * (dark.transpose() * hessian * dark).ldlt().solve(cross.transpose());
  }
  const double misfit = progress.system.weighted_error / std::max(1e-9, progress.system.weight);
  Vector6d floor;
  floor << Eigen::Vector3d::Constant(options.translation_floor * options.translation_floor),
      Eigen::Vector3d::Constant(options.rotation_floor * options.rotation_floor);
  const Eigen::MatrixXd covariance =
      kCorrelatedResiduals * std::max(1.0, misfit) * reduced.inverse() +
      seen.transpose() * Matrix6d(floor.asDiagonal()) * seen;
  const Matrix6d information = seen * covariance.inverse() * seen.transpose();
  return 0.5 * (information + information.transpose());
}

bool leftTheGuess(const Eigen::Isometry3d& T_target_source_guess, const Eigen::Isometry3d& T,
                  const IcapOptions& options) {
  const Eigen::Isometry3d correction = T_target_source_guess.inverse() * T;
  return !(correction.translation().norm() <= options.max_correction &&
           rotationAngle(correction) <= options.max_rotation);
}

IcapStatus statusOf(const AlignmentProgress& progress,
                    const Eigen::Isometry3d& T_target_source_guess, const IcapOptions& options) {
  if (!progress.enough) return IcapStatus::kTooFewPlanes;
  if (!(progress.last_step < kRestlessStep) ||
      leftTheGuess(T_target_source_guess, progress.T_target_source, options)) {
    return IcapStatus::kDiverged;
  }
  return progress.observability.unobserved.cols() > 0 ? IcapStatus::kDegenerate
                                                      : IcapStatus::kConverged;
}

IcapResult describe(const PlaneSet& target, const PlaneSet& source,
                    const AlignmentProgress& progress, IcapStatus status,
                    const IcapOptions& options) {
  IcapResult result;
  result.status = status;
  result.iterations = progress.iterations;
  result.T_target_source = progress.T_target_source;
  if (status == IcapStatus::kTooFewPlanes) return result;
  result.inliers = static_cast<int>(progress.matches.size());
  result.rms_algebraic_error =
      std::sqrt(progress.system.squared_distance / static_cast<double>(progress.matches.size()));
  result.overlap =
      checkVisibility(target, source, result.T_target_source, options.visibility).overlap();
  if (status == IcapStatus::kDiverged) return result;
  result.information = calibratedInformation(progress, options);
  for (Eigen::Index i = 0; i < progress.observability.unobserved.cols(); ++i) {
    result.unobserved.push_back(progress.observability.unobserved.col(i));
  }
  return result;
}

/// Algorithm 2 as printed, judged like the robust form.
AlignmentProgress alignPaperForm(const PlaneSet& target, const PlaneSet& source,
                                 const Eigen::Isometry3d& T_target_source_guess,
                                 const IcapOptions& options) {
  AlignmentProgress progress;
  progress.T_target_source = T_target_source_guess;
  const std::size_t least = static_cast<std::size_t>(options.min_matches);
  if (target.patches(PlaneSet::Level::kWhole).size() < least ||
      source.patches(PlaneSet::Level::kWhole).size() < least) {
    return progress;
  }
  PaperAlignment aligned =
      alignAsPrinted(target, source, T_target_source_guess, options.max_iterations);
  progress.T_target_source = aligned.T_target_source;
  progress.matches = std::move(aligned.matches);
  progress.iterations = aligned.iterations;
  progress.enough = true;
  progress.last_step = aligned.settled ? 0.0 : kRestlessStep;
  progress.system = buildNormalEquations(progress.matches, progress.T_target_source,
                                         options.kernel_width, options);
  progress.observability = analyseObservability(progress.system, options.observability);
  return progress;
}

}  // namespace

std::string toString(IcapStatus status) {
  switch (status) {
    case IcapStatus::kConverged:
      return "converged";
    case IcapStatus::kDegenerate:
      return "degenerate";
    case IcapStatus::kTooFewPlanes:
      return "too_few_planes";
    case IcapStatus::kDiverged:
      return "diverged";
  }
  throw std::invalid_argument("IcapStatus: not an enumerator");
}

IcapResult icap(const PlaneSet& target, const PlaneSet& source,
                const Eigen::Isometry3d& T_target_source_guess, const IcapOptions& options) {
  options.check();
  AlignmentProgress progress = options.form == IcapForm::kPaper
                                   ? alignPaperForm(target, source, T_target_source_guess, options)
                                   : alignRobustly(target, source, T_target_source_guess, options);
  const IcapStatus status = statusOf(progress, T_target_source_guess, options);
  if (status == IcapStatus::kTooFewPlanes) progress.T_target_source = T_target_source_guess;
  return describe(target, source, progress, status, options);
}

}  // namespace planecloud
