// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tracking_trials.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <random>

#include "planecloud_slam/rosbags/hallway_recording.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"

namespace planecloud {
namespace {

using Random = std::mt19937_64;
using Disturbance = std::function<void(RgbdFrame& frame, double seconds, Random& random)>;

constexpr float kNoDepth = std::numeric_limits<float>::quiet_NaN();

std::uint8_t toGrey(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// Grey of one level with the noise of the camera.
void fillGrey(Image<std::uint8_t>& grey, double level, Random& random) {
  std::normal_distribution<double> noise(0.0, 1.1);
  for (std::uint8_t& pixel : grey) pixel = toGrey(level + noise(random));
}

void coverLens(RgbdFrame& frame, double, Random& random) {
  fillGrey(frame.grey, 4.0, random);
  std::fill(frame.depth.begin(), frame.depth.end(), kNoDepth);
}

void showBlankWall(RgbdFrame& frame, double, Random& random) {
  fillGrey(frame.grey, 180.0, random);
  std::normal_distribution<float> noise(0.0F, 0.002F);
  for (float& depth : frame.depth) depth = 1.0F + noise(random);
}

void blackColor(RgbdFrame& frame, double, Random&) {
  std::fill(frame.grey.begin(), frame.grey.end(), std::uint8_t{0});
}

void dropDepth(RgbdFrame& frame, double, Random&) {
  std::fill(frame.depth.begin(), frame.depth.end(), kNoDepth);
}

/// A dark room: the light goes down within 0.2 s, and what is left drowns in noise.
void switchLightOff(RgbdFrame& frame, double seconds, Random& random) {
  const double gain = std::max(0.005, 1.0 - 5.0 * seconds);
  std::normal_distribution<double> noise(0.0, 1.1);
  for (std::uint8_t& pixel : frame.grey) pixel = toGrey(gain * pixel + noise(random));
}

void doubleExposure(RgbdFrame& frame, double, Random&) {
  for (std::uint8_t& pixel : frame.grey) pixel = toGrey(2.0 * pixel);
}

/// Where somebody can pass in front of what a frame shows: at 1.2 m, or nearer where that is near.
float passingDistance(const RgbdFrame& frame) {
  std::vector<float> depths;
  std::copy_if(frame.depth.begin(), frame.depth.end(), std::back_inserter(depths),
               [](float z) { return z > 0.0F; });
  if (depths.empty()) return 1.2F;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return std::min(1.2F, 0.65F * *middle);
}

/// Somebody crosses the view from left to right within 2 s, as wide as half the image.
void walkThrough(RgbdFrame& frame, double seconds, float distance, Random& random) {
  const int width = frame.grey.width();
  const int left = static_cast<int>((0.75 * seconds - 0.5) * width);
  std::normal_distribution<float> noise(0.0F, 0.003F);
  for (int y = frame.grey.height() / 8; y < frame.grey.height(); ++y) {
    for (int x = std::max(0, left); x < std::min(width, left + width / 2); ++x) {
      const double u = 2.0 * (x - left) / width;
      frame.grey(x, y) = toGrey(90.0 + 50.0 * std::sin(40.0 * u) * std::cos(0.05 * y));
      frame.depth(x, y) =
          distance + static_cast<float>(0.3 * (2.0 * u - 1.0) * (2.0 * u - 1.0)) + noise(random);
    }
  }
}

double framePeriod(const FrameSet& set) {
  return (set.frames.back()->stamp - set.frames.front()->stamp) /
         static_cast<double>(set.frames.size() - 1);
}

std::size_t frameCount(const FrameSet& set, double seconds) {
  return static_cast<std::size_t>(std::lround(seconds / framePeriod(set)));
}

Trial disturb(const FrameSet& set, const std::string& name, std::size_t begin, double seconds,
              std::uint64_t seed, const Disturbance& disturbance) {
  Trial trial{name, set, begin, std::min(set.frames.size(), begin + frameCount(set, seconds)),
              false};
  Random random(seed);
  const double start = set.frames[begin]->stamp;
  for (std::size_t i = trial.begin; i < trial.end; ++i) {
    auto frame = std::make_shared<RgbdFrame>(*set.frames[i]);
    disturbance(*frame, frame->stamp - start, random);
    trial.set.frames[i] = frame;
  }
  return trial;
}

/// Removes frames; the wheels of the next one bridge the gap.
Trial dropFrames(const FrameSet& set, const std::string& name, std::size_t begin, double seconds) {
  Trial trial{name, set, begin, begin, false};
  const auto from = static_cast<std::ptrdiff_t>(begin);
  const auto to = static_cast<std::ptrdiff_t>(
      std::min(set.frames.size() - 1, begin + frameCount(set, seconds)));
  trial.set.frames.erase(trial.set.frames.begin() + from, trial.set.frames.begin() + to);
  if (set.wheels.empty()) return trial;
  Eigen::Isometry3d gap = Eigen::Isometry3d::Identity();
  for (std::ptrdiff_t i = from; i <= to; ++i) {
    const auto& motion = set.wheels[static_cast<std::size_t>(i)];
    if (motion) gap = gap * *motion;
  }
  trial.set.wheels.erase(trial.set.wheels.begin() + from, trial.set.wheels.begin() + to);
  trial.set.wheels[begin] = gap;
  return trial;
}

/// At `begin` the camera is carried back to where it was `seconds` before, and goes on from there.
Trial kidnap(const FrameSet& set, std::size_t begin, double seconds) {
  Trial trial{"kidnapped", set, begin, begin, false};
  const std::size_t back = frameCount(set, seconds);
  trial.set.frames.resize(begin);
  trial.set.wheels.clear();
  const double shift = set.frames[begin]->stamp - set.frames[begin - back]->stamp;
  const double split = set.frames[begin]->stamp - 1e-3;
  trial.set.truth.erase(
      std::remove_if(trial.set.truth.begin(), trial.set.truth.end(),
                     [&](const StampedPose& pose) { return pose.stamp >= split; }),
      trial.set.truth.end());
  // Neither side of the split may be interpolated with the other.
  if (const auto T = poseAt(set.truth, split)) trial.set.truth.push_back({split, *T});
  const double after = split + 1e-4;
  if (const auto T = poseAt(set.truth, after - shift)) trial.set.truth.push_back({after, *T});
  for (const StampedPose& pose : set.truth) {
    if (pose.stamp + shift <= after) continue;
    trial.set.truth.push_back({pose.stamp + shift, pose.pose});
  }
  for (std::size_t i = begin - back; i < set.frames.size(); ++i) {
    auto frame = std::make_shared<RgbdFrame>(*set.frames[i]);
    frame->stamp += shift;
    trial.set.frames.push_back(frame);
  }
  return trial;
}

}  // namespace

std::vector<Trial> makeTrials(const FrameSet& set, std::uint64_t seed) {
  Random random(seed);
  const std::size_t third = set.frames.size() / 3;
  const std::size_t begin = third + random() % (set.frames.size() / 6);
  std::vector<Trial> trials;
  const auto blind = [&](const char* name, double seconds, const Disturbance& disturbance) {
    trials.push_back(disturb(set, name, begin, seconds, seed, disturbance));
    trials.back().is_blind = true;
  };
  blind("lens covered 2 s", 2.0, coverLens);
  blind("blank wall 3 s", 3.0, showBlankWall);
  blind("colour black 2 s", 2.0, blackColor);
  blind("depth zero 2 s", 2.0, dropDepth);
  trials.push_back(disturb(set, "lights off 1.5 s", begin, 1.5, seed, switchLightOff));
  trials.push_back(disturb(set, "exposure doubled", begin, 1.0, seed, doubleExposure));
  const float distance = passingDistance(*set.frames[begin]);
  const auto walk = [=](RgbdFrame& frame, double seconds, Random& noise) {
    walkThrough(frame, seconds, distance, noise);
  };
  trials.push_back(disturb(set, "person walks through", begin, 2.0, seed, walk));
  trials.push_back(dropFrames(set, "frames dropped 1 s", begin, 1.0));
  trials.push_back(dropFrames(set, "topic silent 2 s", begin, 2.0));
  trials.push_back(kidnap(set, begin, 0.8 * framePeriod(set) * static_cast<double>(begin)));
  return trials;
}

Trial makeFastTurn(std::uint64_t seed, const CameraIntrinsics& camera) {
  constexpr double kPeriod = 1.0 / HallwayRecording::kFramesPerSecond;
  constexpr double kRate = 120.0 * M_PI / 180.0;  // [rad/s]
  constexpr double kRamp = 0.3;                   // [s]
  constexpr double kTurn = 1.2;                   // [s] at full rate
  HallwayOptions options;
  options.seed = seed;
  options.duration = 5.0 + static_cast<double>(seed % 20);
  options.camera = camera;
  const auto world = std::make_shared<const HallwayWorld>(seed);
  const HallwayRecording path(options, world);
  const Eigen::Isometry3d T_world_start = path.groundTruth().back().pose;
  HallwayRenderer renderer(world, camera);
  Trial trial{"120 degrees per second", {}, 15, 15, false};
  trial.set.name = trial.name;
  trial.set.camera = camera;
  double angle = 0.0;
  for (std::uint64_t i = 0; i < 90; ++i) {
    const double t = static_cast<double>(i) * kPeriod;
    // Stands 1 s, turns, stands, and turns back.
    const double into = t < 3.5 ? t - 1.0 : t - 3.5;
    const double rate =
        kRate * std::clamp(std::min(into, 2.0 * kRamp + kTurn - into) / kRamp, 0.0, 1.0);
    if (rate > 0.0) trial.end = i + 1;
    angle += (t < 3.5 ? 1.0 : -1.0) * rate * kPeriod;
    const Eigen::Isometry3d T_world_camera =
        T_world_start * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY());
    const RenderedView view = renderer.render(T_world_camera);
    const SensorFrame sensed{seed, i, t};
    const Image<std::uint16_t> depth = AstraSensorModel().senseDepth(view, sensed);
    const Image<Rgb8> color = AstraSensorModel().senseColor(view, sensed);
    auto frame = std::make_shared<RgbdFrame>();
    frame->stamp = 1000.0 + t;
    frame->grey.resize(camera.width, camera.height);
    frame->depth.resize(camera.width, camera.height);
    for (std::size_t k = 0; k < depth.size(); ++k) {
      const Rgb8& pixel = color.begin()[k];
      frame->grey.begin()[k] = toGrey(0.299 * pixel.r + 0.587 * pixel.g + 0.114 * pixel.b);
      const std::uint16_t millimetres = depth.begin()[k];
      frame->depth.begin()[k] =
          millimetres == 0 ? kNoDepth : 0.001F * static_cast<float>(millimetres);
    }
    trial.set.truth.push_back({frame->stamp, T_world_camera});
    trial.set.frames.push_back(frame);
  }
  return trial;
}

}  // namespace planecloud
