// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/robot_replay.h"

#include <cmath>
#include <cstdint>
#include <sstream>
#include <utility>

#include "planecloud_slam/plane_fit/keyframe_rounding.h"
#include "planecloud_slam/rosbags/color_image.h"
#include "planecloud_slam/rosbags/read_ahead.h"
#include "planecloud_slam/rosbags/stopwatch.h"

namespace planecloud {
namespace {

std::uint64_t nanoseconds(double stamp) {
  return stamp > 0.0 ? static_cast<std::uint64_t>(std::llround(stamp * 1e9)) : 0;
}

FrontendOptions compressorOptions(const RobotReplayOptions& options) {
  FrontendOptions frontend = options.frontend;
  if (!options.history) frontend.history.edges = 0;
  return frontend;
}

std::string describeJump(const std::string& robot, double from, double to) {
  std::ostringstream text;
  text.precision(3);
  text << std::fixed << robot << ": time went back by " << from - to << " s at stamp " << to
       << "; a new segment begins";
  return text.str();
}

}  // namespace

class RobotReplay::Impl {
 public:
  Impl(std::shared_ptr<Recording> recording, std::size_t index, const RobotReplayOptions& options)
      : recording_(std::move(recording)),
        index_(index),
        options_(options),
        compressor_(compressorOptions(options)) {
    recording_->camera().check();
    source_ = [this] { return readFrame(); };
    if (options.read_ahead > 0) {
      reader_ = std::make_unique<ReadAhead<RgbdFrame>>(source_, options.read_ahead);
      source_ = [this] { return reader_->next(); };
    }
  }

  std::optional<ReplayedFrame> next() {
    if (ended_) return std::nullopt;
    std::optional<RgbdFrame> frame = source_();
    ReplayedFrame step;
    step.robot = index_;
    if (frame) {
      track(*frame, step);
    } else {
      ended_ = true;
      if (!frontend_) return std::nullopt;
      step.stamp = last_stamp_;
      frontend_->finish();
    }
    for (CompletedKeyframe& completed : frontend_->takeCompleted()) {
      step.keyframes.push_back(compress(std::move(completed)));
    }
    return step;
  }

 private:
  std::optional<RgbdFrame> readFrame() {
    if (options_.max_frames > 0 && frames_read_ == options_.max_frames) return std::nullopt;
    ++frames_read_;
    std::optional<RgbdFrame> frame = recording_->next();
    const bool wants_color = options_.frontend.texture.format == TextureFormat::kColor;
    if (frame && wants_color) frame->color = toRgb8(recording_->color());
    return frame;
  }

  void track(const RgbdFrame& frame, ReplayedFrame& step) {
    if (!frontend_) {
      // The session starts with the recording, so that a replay never depends on the clock.
      frontend_ = std::make_unique<Frontend>(options_.frontend, recording_->camera(),
                                             recording_->robot(), nanoseconds(frame.stamp));
      if (const auto T_odom_camera = recording_->startPose()) {
        frontend_->setNextPose(*T_odom_camera);
      }
    } else if (frame.stamp < last_stamp_) {
      step.note = describeJump(recording_->robot(), last_stamp_, frame.stamp);
      frontend_->startNewSegment();
    }
    last_stamp_ = frame.stamp;
    step.stamp = frame.stamp;
    const Stopwatch stopwatch;
    step.result = frontend_->track(frame);
    step.track_time = stopwatch.elapsed();
  }

  ReplayedKeyframe compress(CompletedKeyframe completed) {
    const Stopwatch stopwatch;
    Keyframe keyframe = compressor_.compress(std::move(completed));
    const double fit_time = stopwatch.elapsed();
    return {asTravelled(std::move(keyframe)), fit_time};
  }

  const std::shared_ptr<Recording> recording_;
  const std::size_t index_;
  const RobotReplayOptions options_;
  KeyframeCompressor compressor_;
  std::unique_ptr<Frontend> frontend_;  ///< made with the first frame
  std::size_t frames_read_ = 0;
  double last_stamp_ = 0.0;
  bool ended_ = false;
  std::function<std::optional<RgbdFrame>()> source_;
  std::unique_ptr<ReadAhead<RgbdFrame>> reader_;  // last: its thread reads the members above
};

RobotReplay::RobotReplay(std::shared_ptr<Recording> recording, std::size_t index,
                         const RobotReplayOptions& options)
    : impl_(std::make_unique<Impl>(std::move(recording), index, options)) {}
RobotReplay::~RobotReplay() = default;
RobotReplay::RobotReplay(RobotReplay&&) noexcept = default;
RobotReplay& RobotReplay::operator=(RobotReplay&&) noexcept = default;

std::optional<ReplayedFrame> RobotReplay::next() { return impl_->next(); }

}  // namespace planecloud
