// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "planecloud_slam/rosbags/hallway_recording.h"

namespace planecloud {
namespace {

HallwayOptions brief(double duration) {
  HallwayOptions options;
  options.seed = 11;
  options.duration = duration;
  return options;
}

/// The frame at `index`, the others skipped.
RgbdFrame frameAt(HallwayRecording& recording, int index) {
  for (int i = 0; i < index; ++i) (void)recording.next();
  return recording.next().value();
}

TEST(HallwayRecording, GivesOnePairPerFifteenthOfASecondAndItsPose) {
  HallwayRecording recording(brief(0.2));
  EXPECT_EQ(recording.size(), 4U);
  EXPECT_EQ(recording.robot(), "robot1");
  std::size_t frames = 0;
  while (const std::optional<RgbdFrame> frame = recording.next()) {
    EXPECT_EQ(frame->stamp, recording.groundTruth()[frames].stamp);
    EXPECT_NEAR(frame->stamp - recording.groundTruth()[0].stamp, static_cast<double>(frames) / 15.0,
                1e-6);
    EXPECT_EQ(frame->grey.width(), 640);
    EXPECT_EQ(frame->depth.height(), 480);
    ++frames;
  }
  EXPECT_EQ(frames, 4U);
}

TEST(HallwayRecording, RenderedNoiseFitsTheSensorsFigures) {
  HallwayRecording recording(brief(2.0));
  std::vector<double> squares(9, 0.0);
  std::vector<double> counts(9, 0.0);
  for (const int skipped : {0, 6, 6}) {
    const RgbdFrame sensed = frameAt(recording, skipped);
    const Image<float> truth = recording.trueDepth().value();
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double z = sensed.depth.begin()[i];
      if (!(z > 0.0)) continue;
      const double error = 42.75 / z - 42.75 / double{truth.begin()[i]};
      const auto bin = static_cast<std::size_t>(z);
      squares[bin] += error * error;
      counts[bin] += 1.0;
    }
  }
  for (std::size_t bin = 1; bin < 8; ++bin) {
    if (counts[bin] < 1000.0) continue;
    const double deviation = std::sqrt(squares[bin] / counts[bin]);
    EXPECT_GE(deviation, 0.15) << "between " << bin << " and " << bin + 1 << " m";
    EXPECT_LE(deviation, 0.30) << "between " << bin << " and " << bin + 1 << " m";
  }
  EXPECT_GT(counts[1], 1000.0);
  EXPECT_GT(counts[4], 1000.0);
}

TEST(HallwayRecording, DepthIsInWholeMillimetres) {
  HallwayRecording recording(brief(0.1));
  const RgbdFrame frame = recording.next().value();
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const std::uint16_t millimetres = recording.depthMillimetres().begin()[i];
    const float metres = frame.depth.begin()[i];
    if (millimetres == 0) {
      ASSERT_TRUE(std::isnan(metres));
    } else {
      ASSERT_EQ(metres, 0.001F * static_cast<float>(millimetres));
    }
  }
}

TEST(HallwayRecording, WithoutNoiseDepthIsTheTruth) {
  HallwayOptions options = brief(0.1);
  options.noise = false;
  HallwayRecording recording(options);
  const RgbdFrame frame = recording.next().value();
  const Image<float> truth = recording.trueDepth().value();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_NEAR(frame.depth.begin()[i], truth.begin()[i], 0.00051);  // half a millimetre
  }
}

TEST(HallwayRecording, IsTheSameEveryTimeAndAnotherForAnotherSeed) {
  HallwayRecording a(brief(0.1));
  HallwayRecording b(brief(0.1));
  HallwayOptions other = brief(0.1);
  other.seed = 12;
  HallwayRecording c(other);
  const RgbdFrame first = a.next().value();
  const RgbdFrame same = b.next().value();
  const RgbdFrame different = c.next().value();
  EXPECT_TRUE(std::equal(first.grey.begin(), first.grey.end(), same.grey.begin()));
  EXPECT_FALSE(std::equal(first.grey.begin(), first.grey.end(), different.grey.begin()));
  EXPECT_EQ(a.depthMillimetres().size(), b.depthMillimetres().size());
  EXPECT_TRUE(std::equal(a.depthMillimetres().begin(), a.depthMillimetres().end(),
                         b.depthMillimetres().begin()));
}

TEST(HallwayRecording, RobotsStartElsewhereAndShareSecondsOfTheirWay) {
  HallwayOptions options = brief(84.0);
  options.robots = 3;
  const auto robots = makeHallwayRecordings(options);
  ASSERT_EQ(robots.size(), 3U);
  EXPECT_EQ(robots[2]->robot(), "robot3");
  for (std::size_t k = 1; k < 3; ++k) {
    const Trajectory& mine = robots[k]->groundTruth();
    const Trajectory& other = robots[0]->groundTruth();
    EXPECT_GT((mine[0].pose.translation() - other[0].pose.translation()).norm(), 2.0);
    std::size_t shared = 0;
    for (const StampedPose& here : mine) {
      shared += std::any_of(other.begin(), other.end(), [&](const StampedPose& there) {
        const Eigen::Isometry3d between = here.pose.inverse() * there.pose;
        return between.translation().norm() < 0.3 &&
               Eigen::AngleAxisd(between.linear()).angle() < 0.3;
      });
    }
    EXPECT_GT(shared, 30U * 15U) << "30 s";
  }
}

TEST(HallwayRecording, NamesOptionsOutOfRange) {
  HallwayOptions options;
  options.robots = 17;
  EXPECT_THROW(HallwayRecording{options}, std::invalid_argument);
  options.robots = 2;
  options.robot = 2;
  EXPECT_THROW(HallwayRecording{options}, std::invalid_argument);
}

}  // namespace
}  // namespace planecloud
