// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>

#include "bench_tracking.h"
#include "quantile.h"

namespace planecloud::bench {
namespace {

/// Means over the spacings.
struct Row {
  double median = 0.0, p95 = 0.0, odometry_ate = 0.0, rpe = 0.0, turn_rpe = 0.0, drift = 0.0,
         ate = 0.0;
  double keyframes_per_metre = 0.0, kilobytes_per_metre = 0.0, lost = 0.0;
};

Row measure(const std::shared_ptr<const FrameSet>& set, FrontendOptions options) {
  Row row;
  std::vector<double> times;
  const double share = 1.0 / static_cast<double>(spacings().size());
  const double metres = pathLength(set->truth);
  for (const double spacing : spacings()) {
    options.keyframe.max_translation = spacing;
    const TrackingRun run = track(*set, options);
    const TrajectoryErrors errors = odometryErrors(*set, run);
    times.insert(times.end(), run.track_times.begin(), run.track_times.end());
    row.odometry_ate += share * errors.ate_rmse;
    row.rpe += share * errors.rpe_trans_rmse;
    row.turn_rpe += share * errors.rpe_rot_rmse * 180.0 / M_PI;
    row.drift += share * errors.end_drift;
    row.ate += share * systemErrors(set, options).ate_rmse;
    row.keyframes_per_metre += share * static_cast<double>(run.keyframes.size()) / metres;
    row.kilobytes_per_metre += share * 1e-3 * run.sending_bytes / metres;
    for (const FrameResult& frame : run.frames) {
      row.lost += share * (frame.status == TrackingStatus::kLost ? 1.0 : 0.0);
    }
  }
  row.median = quantile(times, 0.5);
  row.p95 = quantile(times, 0.95);
  return row;
}

struct Switch {
  const char* name;
  std::function<void(FrontendOptions&)> turn;
};

const std::vector<Switch>& switches() {
  static const std::vector<Switch> table = {
      {"default", [](FrontendOptions&) {}},
      {"no history edges", [](FrontendOptions& o) { o.history.edges = 0; }},
      {"no gain and offset",
       [](FrontendOptions& o) { o.tracking.brightness = BrightnessModel::kConstant; }},
      {"offset only", [](FrontendOptions& o) { o.tracking.brightness = BrightnessModel::kOffset; }},
      {"no motion prior",
       [](FrontendOptions& o) { o.tracking.prior_translation = o.tracking.prior_rotation = 0.0; }},
      {"nearly Gaussian weights",
       [](FrontendOptions& o) { o.tracking.degrees_of_freedom = 100.0; }},
      {"no flat pixels", [](FrontendOptions& o) { o.tracking.flat_grid_step = 64; }},
      {"planar motion", [](FrontendOptions& o) { o.planar = true; }},
      {"no colour motion", [](FrontendOptions& o) { o.tracking.color_motion = false; }},
      {"no planes as landmarks", [](FrontendOptions& o) { o.tracking.plane_landmarks = false; }},
      {"640x480 finest", [](FrontendOptions& o) { o.tracking.finest_width = 640; }},
      {"no entropy ratio", [](FrontendOptions& o) { o.keyframe.min_entropy_ratio = 0.0; }},
      {"no depth fusion", [](FrontendOptions& o) { o.local_map.fuse = false; }},
      {"no rectification", [](FrontendOptions& o) { o.undistort = false; }},
  };
  return table;
}

}  // namespace

void runAblation(const FrameSets& sets, const FrontendOptions& options, bool default_only) {
  std::printf("means over keyframe spacings of 0.15, 0.20, 0.25 and 0.30 m\n");
  for (const auto& set : sets) {
    std::printf("%-24s %7s %7s %6s %8s %8s %6s %7s %8s %6s %6s\n", set->name.c_str(), "median",
                "p95 ms", "lost", "odo ATE", "RPE m/s", "deg/s", "drift%", "sys ATE", "kf/m",
                "KB/m");
    for (const Switch& turned : switches()) {
      FrontendOptions changed = options;
      turned.turn(changed);
      const Row row = measure(set, changed);
      std::printf("%-24s %7.2f %7.2f %6.1f %8.4f %8.4f %6.3f %7.2f %8.4f %6.1f %6.1f\n",
                  turned.name, 1e3 * row.median, 1e3 * row.p95, row.lost, row.odometry_ate, row.rpe,
                  row.turn_rpe, 100.0 * row.drift, row.ate, row.keyframes_per_metre,
                  row.kilobytes_per_metre);
      std::fflush(stdout);
      if (default_only) break;
    }
  }
}

}  // namespace planecloud::bench
