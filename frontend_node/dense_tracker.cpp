// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/dense_tracker.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace planecloud {
namespace {

constexpr std::size_t kMinPoints = 60;
/// From so many starts on, that many are followed.
constexpr std::size_t kManyStarts = 6;
/// Steps that leave the residuals' scale larger than the best by more than this (log) are taken
/// back when several in a row do not lead below it.
constexpr double kMaxLogGrowth = 0.02;
constexpr int kMaxWorseSteps = 4;
/// On coarser levels far starts get worse, as more comes into view, before they get better.
constexpr int kMaxWorseCoarseSteps = 12;
/// Weak prior of a brightness step: 100 grey levels, a factor of two.
constexpr double kOffsetInformation = 1e-4;
constexpr double kGainInformation = 1.0 / (64.0 * 64.0);
/// Passes that bring a scale from nothing, and from the coarser level, to its fixed point.
constexpr int kFirstScalePasses = 10;
constexpr int kLevelScalePasses = 3;
constexpr int kMisfitPasses = 5;
constexpr double kDepthNoise = 2e-3;  ///< of inverse depth [1/m], see DepthNoiseModel
constexpr double kStartSigmaGrey = 20.0;
constexpr double kStartSigmaQ = 0.05;
constexpr double kMinGain = 0.1;
constexpr double kMaxGain = 10.0;

/// Starts that share less than this of the reference's points are not compared with others.
constexpr double kComparableShare = 0.25;

bool isComparable(const ReferencePoints& points, const Residuals& residuals) {
  return residuals.seen_count >= kMinPoints &&
         static_cast<double>(residuals.seen_count) >=
             kComparableShare * static_cast<double>(points.count);
}

/// Applies `step` to brightness, see `kUnknowns`.
Brightness updateBrightness(const Brightness& brightness, const StepVector& step) {
  const double gain_change = step(7) / 64.0;
  Brightness updated;
  updated.gain = brightness.gain * (1.0 + gain_change);
  updated.gain = std::min(std::max(updated.gain, kMinGain), kMaxGain);
  updated.offset = brightness.offset + brightness.gain * (step(6) - 128.0 * gain_change);
  return updated;
}

/// Removes the brightness unknowns: the information of the twist alone.
Matrix6d marginalPoseInformation(const StepMatrix& matrix) {
  const Eigen::Matrix<double, 6, 2> cross = matrix.topRightCorner<6, 2>();
  const Eigen::Matrix2d brightness = matrix.bottomRightCorner<2, 2>();
  return matrix.topLeftCorner<6, 6>() - cross * brightness.inverse() * cross.transpose();
}

}  // namespace

/// What one alignment carries from iteration to iteration.
struct DenseTracker::State {
  Eigen::Isometry3d T_current_reference = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_current_reference_prior = Eigen::Isometry3d::Identity();
  Brightness brightness;
  ResidualScale scale{kStartSigmaGrey, kStartSigmaQ, 0.0};
  NormalEquations equations;  ///< of the last iteration, without prior
  int iterations = 0;
  bool is_finest = false;  ///< of the levels
};

DenseTracker::DenseTracker(const DenseTrackerOptions& options)
    : options_(options),
      scale_model_{options.degrees_of_freedom, options.min_sigma_grey,
                   options.min_sigma_inverse_depth} {
  options_.check();
}

/// How badly the last residuals fit: log of their scale, depth counted to its noise and not only to
/// the floor that balances it with grey.
double DenseTracker::misfit(const ReferencePoints& points, ResidualScale scale) const {
  if (!isComparable(points, residuals_)) return std::numeric_limits<double>::max();
  ScaleModel model = scale_model_;
  model.min_sigma_q = std::min(model.min_sigma_q, kDepthNoise);
  for (int pass = 0; pass < kMisfitPasses; ++pass) {
    scale = reestimateScale(residuals_.view(), scale, model);
  }
  return scale.logVolume();
}

std::vector<DenseTracker::State> DenseTracker::rankStarts(const ReferencePoints& points,
                                                          const RgbdLevel& current,
                                                          const AlignmentStart& start) {
  std::vector<std::pair<double, State>> ranked;
  const auto allowed = [this](const Eigen::Isometry3d& T) {
    return planar_ ? planar_->nearest(T) : T;
  };
  for (const Eigen::Isometry3d& T_reference_current : start.T_reference_current) {
    State state;
    state.brightness = start.brightness;
    state.T_current_reference = allowed(T_reference_current.inverse());
    state.T_current_reference_prior = allowed(start.T_reference_current.front().inverse());
    computeResiduals(points, current, state.T_current_reference, state.brightness, residuals_);
    for (int pass = 0; pass < kFirstScalePasses; ++pass) {
      state.scale = reestimateScale(residuals_.view(), state.scale, scale_model_);
    }
    ranked.emplace_back(misfit(points, state.scale), state);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<State> states;
  for (const auto& [volume, state] : ranked) states.push_back(state);
  return states;
}

/// With many starts the best few are followed on the coarsest level, which costs little.
DenseTracker::State DenseTracker::chooseStart(const ReferencePoints& points,
                                              const RgbdLevel& current,
                                              const AlignmentStart& start) {
  std::vector<State> states = rankStarts(points, current, start);
  if (states.size() < kManyStarts) return states.front();
  states.resize(kManyStarts);
  State best = states.front();
  double best_misfit = std::numeric_limits<double>::infinity();
  for (State& state : states) {
    const AlignmentStatus status = alignLevel(points, current, state);
    if (status == AlignmentStatus::kTooFewPoints || status == AlignmentStatus::kDegenerate) {
      continue;
    }
    const double at_end = misfit(points, state.scale);
    if (at_end >= best_misfit) continue;
    best_misfit = at_end;
    best = state;
  }
  return best;
}

void DenseTracker::addPrior(const State& state, NormalEquations& equations) const {
  if (options_.prior_translation <= 0.0 && options_.prior_rotation <= 0.0) return;
  const auto weight = [](double sigma) { return sigma > 0.0 ? 1.0 / (sigma * sigma) : 0.0; };
  Vector6d information;
  information.head<3>().setConstant(weight(options_.prior_translation));
  information.tail<3>().setConstant(weight(options_.prior_rotation));
  // The step moves T to T Exp(-xi), and the prior wants T Exp(-xi) = T_prior.
  const Vector6d wanted =
      logSe3(state.T_current_reference_prior.inverse() * state.T_current_reference);
  equations.matrix.topLeftCorner<6, 6>().diagonal() += information;
  equations.vector.head<6>() += information.cwiseProduct(wanted);
}

void DenseTracker::restrictBrightness(NormalEquations& equations) const {
  const int free = options_.brightness == BrightnessModel::kGainAndOffset ? 2
                   : options_.brightness == BrightnessModel::kOffset      ? 1
                                                                          : 0;
  for (int k = 6 + free; k < kUnknowns; ++k) {
    equations.matrix.row(k).setZero();
    equations.matrix.col(k).setZero();
    equations.matrix(k, k) = 1.0;
    equations.vector(k) = 0.0;
  }
}

/// The step; none when it is not determined.
std::optional<StepVector> DenseTracker::solve(const NormalEquations& equations) const {
  const auto solveIn = [&](const auto& basis) -> std::optional<StepVector> {
    const auto ldlt = (basis.transpose() * equations.matrix * basis).eval().ldlt();
    const StepVector step = basis * ldlt.solve(basis.transpose() * equations.vector);
    if (!ldlt.isPositive() || !step.allFinite()) return std::nullopt;
    return step;
  };
  if (!planar_) return solveIn(StepMatrix::Identity().eval());
  Eigen::Matrix<double, kUnknowns, 5> basis = Eigen::Matrix<double, kUnknowns, 5>::Zero();
  basis.topLeftCorner<6, 3>() = planar_->basis();
  basis.bottomRightCorner<2, 2>().setIdentity();
  return solveIn(basis);
}

AlignmentStatus DenseTracker::alignLevel(const ReferencePoints& points, const RgbdLevel& current,
                                         State& state) {
  State best = state;
  double best_volume = std::numeric_limits<double>::infinity();
  int worse_steps = 0;
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration, ++state.iterations) {
    computeResiduals(points, current, state.T_current_reference, state.brightness, residuals_);
    if (residuals_.seen_count < kMinPoints) return AlignmentStatus::kTooFewPoints;
    for (int pass = iteration == 0 ? kLevelScalePasses : 1; pass > 0; --pass) {
      state.scale = reestimateScale(residuals_.view(), state.scale, scale_model_);
    }
    const double volume = state.scale.logVolume();
    worse_steps = volume > best_volume + kMaxLogGrowth ? worse_steps + 1 : 0;
    if (worse_steps == (state.is_finest ? kMaxWorseSteps : kMaxWorseCoarseSteps)) {
      const int iterations = state.iterations;
      state = best;
      state.iterations = iterations;
      computeResiduals(points, current, state.T_current_reference, state.brightness, residuals_);
      return AlignmentStatus::kConverged;
    }
    state.equations = accumulateNormalEquations(points, residuals_.view(), state.scale,
                                                options_.degrees_of_freedom);
    restrictBrightness(state.equations);
    state.equations.matrix(6, 6) += kOffsetInformation;
    state.equations.matrix(7, 7) += kGainInformation;
    if (volume < best_volume) {
      best_volume = volume;
      best = state;
    }
    NormalEquations equations = state.equations;
    addPrior(state, equations);
    const std::optional<StepVector> step = solve(equations);
    if (!step) return AlignmentStatus::kDegenerate;
    state.T_current_reference = state.T_current_reference * expSe3(-step->head<6>());
    state.brightness = updateBrightness(state.brightness, *step);
    if (step->dot(equations.vector) < options_.min_relative_change * state.equations.error) {
      return AlignmentStatus::kConverged;
    }
  }
  return AlignmentStatus::kNotConverged;
}

void DenseTracker::setInformation(const ReferencePoints& points, const State& state,
                                  Alignment& alignment) const {
  const Matrix6d independent = marginalPoseInformation(state.equations.matrix);
  // A twist at the reference, T_current_reference Exp(-xi), is the twist Ad(T_current_reference) xi
  // at the current frame.
  const Matrix6d to_reference = adjoint(alignment.T_reference_current);
  alignment.normal_matrix = to_reference.transpose() * independent * to_reference;
  alignment.information = options_.information_scale * alignment.normal_matrix;
  if (options_.information_block == 0) return;

  const BlockScatter scatter =
      accumulateBlockScatter(points, residuals_.view(), state.scale, options_.degrees_of_freedom);
  if (scatter.blocks <= 2 * kUnknowns) {
    alignment.information /= options_.information_block;
    return;
  }
  StepMatrix S = scatter.matrix;
  NormalEquations restricted{S, StepVector::Zero(), 0.0};
  restrictBrightness(restricted);
  S = restricted.matrix * (scatter.blocks / static_cast<double>(scatter.blocks - kUnknowns));
  const StepMatrix inverse = state.equations.matrix.ldlt().solve(StepMatrix::Identity());
  const Matrix6d clustered = (inverse * S * inverse).topLeftCorner<6, 6>();
  const Matrix6d covariance = inverse.topLeftCorner<6, 6>();
  // The scatter of some dozen blocks is a noisy estimate: lean on the shape of the normal matrix.
  const double inflation = (independent * clustered).trace() / 6.0;
  const Matrix6d blended = 0.5 * (clustered + inflation * covariance);
  const Matrix6d information = blended.ldlt().solve(Matrix6d::Identity());
  alignment.information = options_.information_scale * to_reference.transpose() *
                          (0.5 * (information + information.transpose())) * to_reference;
}

Alignment DenseTracker::align(const TrackingReference& reference, const RgbdPyramid& current,
                              const AlignmentStart& start) {
  const std::vector<ReferencePoints>& points = reference.levels();
  if (points.size() != current.levels().size()) {
    throw std::invalid_argument("reference and current image have different pyramid levels");
  }
  if (start.T_reference_current.empty()) {
    throw std::invalid_argument("an alignment needs at least one start");
  }
  State state = chooseStart(points.back(), current.levels().back(), start);
  Alignment alignment;
  for (std::size_t level = points.size(); level-- > 0;) {
    state.is_finest = level == 0;
    alignment.status = alignLevel(points[level], current.levels()[level], state);
  }
  alignment.T_reference_current = state.T_current_reference.inverse();
  alignment.brightness = state.brightness;
  alignment.scale = state.scale;
  alignment.iterations = state.iterations;
  const auto count = static_cast<double>(std::max<std::size_t>(points.front().count, 1));
  alignment.overlap = static_cast<double>(residuals_.in_image) / count;
  alignment.inliers = static_cast<double>(residuals_.agreeing) /
                      static_cast<double>(std::max<std::size_t>(residuals_.in_image, 1));
  if (alignment.status == AlignmentStatus::kConverged ||
      alignment.status == AlignmentStatus::kNotConverged) {
    setInformation(points.front(), state, alignment);
    if (planar_) alignment.information += planar_->information();
  }
  return alignment;
}

}  // namespace planecloud
