// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/loss_detector.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <sstream>

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {
namespace {

constexpr int kSampleStep = 4;
/// Allowed on top of speed times time: stamps jitter.
constexpr double kMotionSlack = 0.05;  // [m] and [rad]

/// Residuals of good frames are at least this: noise, interpolation [grey levels].
constexpr double kLeastNormalGrey = 3.0;
/// Of a frame in what is normal: the last second counts.
constexpr double kLearningShare = 0.05;
/// Grey residuals count as this many times what is normal at most, and inliers as no fewer than the
/// slack: what moves through the view must not become normal.
constexpr double kMostGrowth = 1.5;
/// After a loss nothing vouches for an alignment but itself.
constexpr double kDoubtlessOverlap = 0.2;
constexpr double kDoubtlessGrowth = 2.5;
constexpr double kInlierSlack = 0.1;
/// A share of agreeing depths this much below the normal. With less of the keyframe in view than
/// this it has to be left anyhow.
constexpr double kObstruction = 0.25;
constexpr double kObstructedOverlap = 0.35;
/// Share of a motion that wheels may be wrong by when they slip.
constexpr double kWheelShare = 0.2;

/// Standard deviation in the least certain of three directions of the twist from `first` on.
double largestDeviation(const Matrix6d& information, int first) {
  const Matrix6d covariance = information.ldlt().solve(Matrix6d::Identity());
  const Eigen::Matrix3d block = covariance.block<3, 3>(first, first);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (block + block.transpose()),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues()(2));
}

std::string compare(const std::string& what, double value, const std::string& relation,
                    double limit) {
  std::ostringstream text;
  text << std::setprecision(3) << what << " " << value << " " << relation << " " << limit;
  return text.str();
}

}  // namespace

LossDetector::LossDetector(const LossOptions& options) : options_(options) { options_.check(); }

std::string LossDetector::findImageFault(const RgbdFrame& frame) const {
  std::int64_t count = 0, grey_sum = 0, grey_squares = 0, valid_count = 0;
  for (int y = 0; y < frame.grey.height(); y += kSampleStep) {
    const std::uint8_t* greys = frame.grey.row(y);
    const float* depths = frame.depth.row(y);
    for (int x = 0; x < frame.grey.width(); x += kSampleStep, ++count) {
      const int grey = greys[x];
      grey_sum += grey;
      grey_squares += grey * grey;
      valid_count += depths[x] > 0.0F && depths[x] < std::numeric_limits<float>::infinity() ? 1 : 0;
    }
  }
  const auto n = static_cast<double>(count), valid = static_cast<double>(valid_count);
  if (valid_count == 0) return "the depth image has no valid pixel";
  if (valid < options_.min_valid_depth * n) {
    return compare("the share of pixels with depth is", valid / n, "<", options_.min_valid_depth);
  }
  const double mean = static_cast<double>(grey_sum) / n;
  const double deviation =
      std::sqrt(std::max(0.0, static_cast<double>(grey_squares) / n - mean * mean));
  if (deviation < options_.min_contrast) {
    return compare("the colour image is blank: its standard deviation is", deviation, "<",
                   options_.min_contrast);
  }
  return "";
}

std::string LossDetector::findAlignmentFault(const Alignment& alignment,
                                             const TrackedMotion& motion) const {
  if (alignment.status == AlignmentStatus::kTooFewPoints) {
    return "too little of the keyframe is in view";
  }
  if (alignment.status == AlignmentStatus::kDegenerate) {
    return "the images do not determine the motion";
  }
  if (alignment.status == AlignmentStatus::kNotConverged) {
    return "the alignment did not converge";
  }
  std::string fault = findWeakness(alignment);
  if (fault.empty() && motion.entropy_ratio < options_.min_entropy_ratio) {
    fault = compare("the entropy ratio is", motion.entropy_ratio, "<", options_.min_entropy_ratio);
  }
  return fault.empty() ? findImplausibleMotion(motion) : fault;
}

std::string LossDetector::findWeakness(const Alignment& alignment) const {
  if (alignment.overlap < options_.min_overlap) {
    return compare("the keyframe's share in view is", alignment.overlap, "<", options_.min_overlap);
  }
  if (alignment.inliers < options_.min_inliers) {
    return compare("the share of agreeing depths is", alignment.inliers, "<", options_.min_inliers);
  }
  if (alignment.scale.sigma_q > options_.max_depth_residual) {
    return compare("the inverse depth residuals [1/m] are", alignment.scale.sigma_q, ">",
                   options_.max_depth_residual);
  }
  const double grey_limit = greyLimit(options_.max_residual_growth);
  if (alignment.scale.sigma_grey > grey_limit) {
    return compare("the grey residuals are", alignment.scale.sigma_grey, ">", grey_limit);
  }
  return findUncertainty(alignment);
}

std::string LossDetector::findUncertainty(const Alignment& alignment) const {
  const double deviation = largestDeviation(alignment.information, 0);
  if (!(deviation <= options_.max_deviation)) {
    return compare("the position's standard deviation [m] is", deviation, ">",
                   options_.max_deviation);
  }
  const double turn_deviation = largestDeviation(alignment.information, 3);
  if (!(turn_deviation <= options_.max_turn_deviation)) {
    return compare("the rotation's standard deviation [rad] is", turn_deviation, ">",
                   options_.max_turn_deviation);
  }
  return "";
}

double LossDetector::greyLimit(double growth) const {
  if (normal_grey_ == 0.0) return options_.max_intensity_residual;
  return std::min(options_.max_intensity_residual,
                  growth * std::max(normal_grey_, kLeastNormalGrey));
}

void LossDetector::learn(const Alignment& alignment) {
  const bool is_first = normal_grey_ == 0.0;
  const double share = is_first ? 1.0 : kLearningShare;
  const double grey = alignment.scale.sigma_grey;
  const double most = kMostGrowth * std::max(normal_grey_, kLeastNormalGrey);
  normal_grey_ += share * ((is_first ? grey : std::min(grey, most)) - normal_grey_);
  const double inliers = std::max(alignment.inliers, normal_inliers_ - kInlierSlack);
  normal_inliers_ += share * (inliers - normal_inliers_);
}

std::string LossDetector::findDoubt(const Alignment& alignment, bool is_lenient) const {
  if (alignment.status != AlignmentStatus::kConverged) return "the alignment did not converge";
  if (alignment.overlap < kDoubtlessOverlap) {
    return compare("the keyframe's share in view is", alignment.overlap, "<", kDoubtlessOverlap);
  }
  const double inliers = std::max(options_.min_inliers, normal_inliers_ - kInlierSlack);
  if (alignment.inliers < inliers) {
    return compare("the share of agreeing depths is", alignment.inliers, "<", inliers);
  }
  const double growth = options_.max_residual_growth;
  const double grey_limit = greyLimit(is_lenient ? growth : std::min(growth, kDoubtlessGrowth));
  if (alignment.scale.sigma_grey > grey_limit) {
    return compare("the grey residuals are", alignment.scale.sigma_grey, ">", grey_limit);
  }
  return findUncertainty(alignment);
}

bool LossDetector::isObstructed(const Alignment& alignment, bool is_wary) const {
  if (alignment.overlap <= kObstructedOverlap) return false;
  return is_wary ? !isOrdinary(alignment) : alignment.inliers < normal_inliers_ - kObstruction;
}

bool LossDetector::isOrdinary(const Alignment& alignment) const {
  return alignment.scale.sigma_grey <= greyLimit(kMostGrowth) &&
         alignment.inliers >= normal_inliers_ - kInlierSlack;
}

std::string LossDetector::findImplausibleMotion(const TrackedMotion& motion) const {
  const double translation = motion.T_previous_current.translation().norm();
  if (translation > options_.max_speed * motion.seconds + kMotionSlack) {
    return compare(
        "the motion [m] since the last good frame is", translation,
        "> what the speed limit allows:", options_.max_speed * motion.seconds + kMotionSlack);
  }
  const double rotation = rotationAngle(motion.T_previous_current);
  if (rotation > options_.max_turn_rate * motion.seconds + kMotionSlack) {
    return compare("the turn [rad] since the last good frame is", rotation,
                   "> what the turn rate limit allows:",
                   options_.max_turn_rate * motion.seconds + kMotionSlack);
  }
  if (!motion.T_previous_current_wheels) return "";
  const Eigen::Isometry3d& T_wheels = *motion.T_previous_current_wheels;
  const Eigen::Isometry3d difference = T_wheels.inverse() * motion.T_previous_current;
  const double allowed = options_.max_guess_error + kWheelShare * T_wheels.translation().norm();
  if (difference.translation().norm() > allowed) {
    return compare("the motion [m] differs from the wheels' by", difference.translation().norm(),
                   ">", allowed);
  }
  const double allowed_turn = options_.max_guess_turn_error + kWheelShare * rotationAngle(T_wheels);
  if (rotationAngle(difference) > allowed_turn) {
    return compare("the turn [rad] differs from the wheels' by", rotationAngle(difference), ">",
                   allowed_turn);
  }
  return "";
}

}  // namespace planecloud
