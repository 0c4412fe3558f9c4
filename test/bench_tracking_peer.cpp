// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/rgbd.hpp>

#include "bench_tracking.h"
#include "planecloud_slam/frontend_node/rectifier.h"
#include "quantile.h"
#include "thread_time.h"

namespace planecloud::bench {
namespace {

cv::Mat cameraMatrix(const CameraIntrinsics& camera) {
  return (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
}

cv::Ptr<cv::rgbd::OdometryFrame> peerFrame(const RgbdFrame& frame) {
  const cv::Mat grey(frame.grey.height(), frame.grey.width(), CV_8UC1,
                     const_cast<std::uint8_t*>(frame.grey.begin()));
  const cv::Mat depth(frame.depth.height(), frame.depth.width(), CV_32FC1,
                      const_cast<float*>(frame.depth.begin()));
  return cv::rgbd::OdometryFrame::create(grey.clone(), depth.clone());
}

/// Frame to frame, as the class is used in its own samples: the previous frame's pyramid is kept.
/// Time counts from the frame as it comes, with its rectification, for both.
TrackingRun trackWithPeer(const FrameSet& set) {
  cv::Ptr<cv::rgbd::RgbdOdometry> odometry =
      cv::rgbd::RgbdOdometry::create(cameraMatrix(set.camera.rectified()), 0.2F, 8.0F);
  std::optional<Rectifier> rectifier;
  if (set.camera.hasDistortion()) rectifier.emplace(set.camera);
  TrackingRun run;
  cv::Ptr<cv::rgbd::OdometryFrame> previous;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const auto& frame : set.frames) {
    const double start = threadTime();
    cv::Ptr<cv::rgbd::OdometryFrame> current =
        peerFrame(rectifier ? rectifier->rectify(*frame) : *frame);
    FrameResult result;
    result.stamp = frame->stamp;
    result.status = TrackingStatus::kTracked;
    cv::Mat motion;
    if (previous && odometry->compute(current, previous, motion)) {
      Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
          T_previous_current.matrix()(row, column) = motion.at<double>(row, column);
        }
      }
      pose = pose * T_previous_current;
    } else if (previous) {
      result.status = TrackingStatus::kLost;
    }
    if (previous) run.track_times.push_back(threadTime() - start);
    result.T_odom_camera = pose;
    run.frames.push_back(result);
    previous = current;
  }
  return run;
}

void print(const char* name, const FrameSet& set, const TrackingRun& run) {
  const TrajectoryErrors errors = odometryErrors(set, run);
  std::size_t lost = 0;
  for (const FrameResult& frame : run.frames) {
    lost += frame.status == TrackingStatus::kLost ? 1U : 0U;
  }
  std::printf("%-22s %-14s %7.2f %7.2f %6zu %8.4f %8.4f %8.3f %7.2f\n", set.name.c_str(), name,
              1e3 * quantile(run.track_times, 0.5), 1e3 * quantile(run.track_times, 0.95), lost,
              errors.ate_rmse, errors.rpe_trans_rmse, errors.rpe_rot_rmse * 180.0 / M_PI,
              100.0 * errors.end_drift);
}

}  // namespace

void comparePeer(const FrameSets& sets, const FrontendOptions& options) {
  cv::setNumThreads(1);
  std::printf("CPU time of one thread; both trackers without loop closures or history\n");
  std::printf("%-22s %-14s %7s %7s %6s %8s %8s %8s %7s\n", "input", "tracker", "median", "p95 ms",
              "lost", "ATE m", "RPE m/s", "deg/s", "drift%");
  for (const auto& set : sets) {
    const TrackingRun own = track(*set, options);
    print("this", *set, own);
    const TrackingRun peer = trackWithPeer(*set);
    print("RgbdOdometry", *set, peer);
    std::printf("%-22s %-14s %6.1fx %6.1fx\n", set->name.c_str(), "faster by",
                quantile(peer.track_times, 0.5) / quantile(own.track_times, 0.5),
                quantile(peer.track_times, 0.95) / quantile(own.track_times, 0.95));
    std::printf("%-22s keyframes per metre: %.1f\n", set->name.c_str(),
                static_cast<double>(own.keyframes.size()) / pathLength(set->truth));
    const double per_frame = (own.keyframe_time + quantile(own.track_times, 0.5) *
                                                      static_cast<double>(own.frames.size())) /
                             static_cast<double>(own.frames.size());
    std::printf("%-22s share of a core at 30 Hz: %.0f %%\n", set->name.c_str(),
                100.0 * 30.0 * per_frame);
  }
}

}  // namespace planecloud::bench
