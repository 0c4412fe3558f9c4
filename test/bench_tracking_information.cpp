// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <map>

#include "bench_tracking.h"
#include "quantile.h"

namespace planecloud::bench {
namespace {

/// 95 % of a chi-squared variable of six degrees of freedom lie below.
constexpr double kChiSquared95 = 12.6;

/// Normalised error squared of one measured edge.
double normalisedError(const RelativePoseEdge& edge, const Eigen::Isometry3d& T_truth) {
  const Vector6d error = logSe3(edge.T_other_this.inverse() * T_truth);
  return error.dot(edge.information * error);
}

/// The edges of a kind over all sets and spacings.
struct Book {
  std::vector<double> errors;
  Vector6d squares = Vector6d::Zero();  ///< by axis, normalised by the edge's own deviation
  std::vector<double> translations, rotations;

  void add(const RelativePoseEdge& edge, const Eigen::Isometry3d& T_truth) {
    errors.push_back(normalisedError(edge, T_truth));
    const Eigen::Isometry3d T_error = edge.T_other_this.inverse() * T_truth;
    translations.push_back(T_error.translation().norm());
    rotations.push_back(rotationAngle(T_error));
    const Matrix6d covariance = edge.information.inverse();
    squares += logSe3(T_error).cwiseAbs2().cwiseQuotient(covariance.diagonal());
  }
};

void print(const char* kind, const Book& book) {
  if (book.errors.empty()) return;
  double sum = 0.0;
  std::size_t below = 0;
  for (const double error : book.errors) {
    sum += error;
    below += error < kChiSquared95 ? 1U : 0U;
  }
  const auto n = static_cast<double>(book.errors.size());
  const Vector6d axes = book.squares / n;
  std::printf(
      "%-10s %5zu %8.2f %8.2f %7.1f %%  %7.2f %7.2f   %5.2f %5.2f %5.2f %5.2f %5.2f %5.2f\n", kind,
      book.errors.size(), sum / n, quantile(book.errors, 0.5),
      100.0 * static_cast<double>(below) / n, 1e3 * quantile(book.translations, 0.5),
      1e3 * quantile(book.rotations, 0.5), axes(0), axes(1), axes(2), axes(3), axes(4), axes(5));
}

void enter(const FrameSet& set, const TrackingRun& run, Book& odometry, Book& history) {
  std::map<KeyframeId, double> stamps;
  for (const Keyframe& keyframe : run.keyframes) {
    stamps[keyframe.id] = keyframe.stamp;
    const std::optional<Eigen::Isometry3d> T_world_this = poseAt(set.truth, keyframe.stamp);
    if (!T_world_this) continue;
    for (std::size_t i = 0; i < keyframe.edges.size(); ++i) {
      const RelativePoseEdge& edge = keyframe.edges[i];
      const auto other = stamps.find(edge.other);
      if (other == stamps.end()) continue;
      const std::optional<Eigen::Isometry3d> T_world_other = poseAt(set.truth, other->second);
      if (!T_world_other) continue;
      (i == 0 ? odometry : history).add(edge, T_world_other->inverse() * *T_world_this);
    }
  }
}

}  // namespace

void judgeInformation(const FrameSets& sets, const FrontendOptions& options) {
  std::printf("normalised error squared of edges, 6 degrees of freedom; last: by axis, 1 each\n");
  std::printf("%-10s %5s %8s %8s %9s  %7s %7s\n", "edges", "n", "mean", "median", "< 12.6", "mm",
              "mrad");
  Book all_odometry, all_history;
  for (const auto& set : sets) {
    Book odometry, history;
    for (const double spacing : spacings()) {
      FrontendOptions spaced = options;
      spaced.keyframe.max_translation = spacing;
      const TrackingRun run = track(*set, spaced);
      enter(*set, run, odometry, history);
      enter(*set, run, all_odometry, all_history);
    }
    std::printf("%s\n", set->name.c_str());
    print("odometry", odometry);
    print("history", history);
  }
  std::printf("all\n");
  print("odometry", all_odometry);
  print("history", all_history);
}

}  // namespace planecloud::bench
