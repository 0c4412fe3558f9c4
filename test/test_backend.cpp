// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "map_truth.h"
#include "planecloud_slam/backend_node/backend.h"
#include "synthetic_robot.h"

namespace planecloud {
namespace {

struct Drive {
  std::vector<Keyframe> keyframes;
  Truth truth;
};

Drive driveHall(const std::string& robot, double start, double distance, unsigned seed) {
  const SyntheticPlanes hall = makeHall();
  SyntheticRobot driver(hall, robot, seed);
  Drive drive;
  for (double s = 0.0; s <= distance; s += 0.3) {
    drive.keyframes.push_back(driver.see(hallPose(start + s)));
    drive.truth.emplace(drive.keyframes.back().id, driver.truth.back());
  }
  return drive;
}

/// One round and a bit, made once.
const Drive& round() {
  static const Drive drive = driveHall("robot1", 0.0, kHallRound + 2.0, 3);
  return drive;
}

Backend mapped(const std::vector<Keyframe>& keyframes,
               const BackendOptions& options = BackendOptions()) {
  Backend backend(options);
  for (const Keyframe& keyframe : keyframes) {
    const InsertionResult result = backend.insert(keyframe);
    EXPECT_EQ(result.status, InsertionStatus::kInserted) << result.reason;
  }
  return backend;
}

TEST(Backend, ClosesTheLoopOfOneRobotAndHalvesItsError) {
  BackendOptions open;
  open.loop_closure.candidates.enabled = false;
  const double odometry = largestError(*mapped(round().keyframes, open).snapshot(), round().truth);
  const Backend backend = mapped(round().keyframes);
  const std::shared_ptr<const MapSnapshot> map = backend.snapshot();
  EXPECT_GE(backend.statistics().closures_intra, 2u);
  EXPECT_EQ(falseClosures(*map, round().truth), 0);
  EXPECT_EQ(map->components, 1);
  EXPECT_GT(odometry, 0.1);
  EXPECT_LT(largestError(*map, round().truth), 0.6 * odometry);
}

TEST(Backend, GivesTheSameBitsTwice) {
  const Backend first = mapped(round().keyframes);
  const Backend second = mapped(round().keyframes);
  const auto a = first.snapshot();
  const auto b = second.snapshot();
  ASSERT_EQ(a->nodes.size(), b->nodes.size());
  for (std::size_t i = 0; i < a->nodes.size(); ++i) {
    EXPECT_EQ(a->nodes[i].T_map_camera.matrix(), b->nodes[i].T_map_camera.matrix());
  }
}

TEST(Backend, JoinsTwoRobotsOfUnknownRelationByWhatTheyBothSaw) {
  Drive first = driveHall("robot1", 0.0, 10.0, 4);
  Drive second = driveHall("robot2", 3.0, 9.0, 5);
  // Each of robot2's keyframes is hinted at the place where robot1 was 0.1 m away.
  for (std::size_t i = 0; i < second.keyframes.size(); ++i) {
    const std::size_t same = i + 10;
    if (same >= first.keyframes.size()) break;
    second.keyframes[i].closure_hints.push_back(first.keyframes[same].id);
  }
  Backend backend = mapped(first.keyframes);
  for (const Keyframe& keyframe : second.keyframes) backend.insert(keyframe);
  Truth truth = first.truth;
  truth.insert(second.truth.begin(), second.truth.end());
  const auto map = backend.snapshot();
  EXPECT_EQ(map->components, 1);
  EXPECT_GE(backend.statistics().closures_inter, 4u);
  EXPECT_EQ(falseClosures(*map, truth), 0);
  EXPECT_LT(largestError(*map, truth), 0.15);
}

TEST(Backend, KeepsRobotsApartThatTheHintsMisplace) {
  Drive first = driveHall("robot1", 0.0, 6.0, 6);
  Drive second = driveHall("robot2", 0.5 * kHallRound, 6.0, 7);  // the other side of the block
  for (std::size_t i = 0; i < second.keyframes.size(); ++i) {
    second.keyframes[i].closure_hints.push_back(first.keyframes[i].id);
  }
  Backend backend = mapped(first.keyframes);
  for (const Keyframe& keyframe : second.keyframes) backend.insert(keyframe);
  const auto map = backend.snapshot();
  EXPECT_EQ(map->components, 2);
  EXPECT_EQ(backend.statistics().closures_inter, 0u);
  // Each hint was a candidate, and the map says what became of it.
  std::map<std::string, std::size_t> rejected;
  std::size_t between_robots = 0;
  for (const RejectedClosure& pair : map->rejected) {
    ++rejected[pair.reason];
    if (pair.from.robot != pair.to.robot) ++between_robots;
  }
  EXPECT_EQ(rejected, backend.statistics().rejected);
  EXPECT_GE(between_robots, second.keyframes.size() / 2);
}

TEST(Backend, LevelsTheMapWithTheFloor) {
  const SyntheticPlanes hall = makeHall();
  SyntheticRobot driver(hall, "robot1", 8);
  Keyframe keyframe = driver.see(hallPose(1.0));
  const Eigen::AngleAxisd tilt(0.2, Eigen::Vector3d(0.6, 0.8, 0.0));
  keyframe.T_odom_camera = tilt * keyframe.T_odom_camera;
  const Backend backend = mapped({keyframe});
  const Eigen::Matrix3d R_map_world =
      backend.snapshot()->nodes[0].T_map_camera.linear() * driver.truth[0].linear().transpose();
  EXPECT_NEAR(std::acos(std::min(1.0, R_map_world(2, 2))), 0.0, 0.005);
}

TEST(Backend, PutsKeyframesThatArriveOutOfOrderWhereTheyBelong) {
  std::vector<Keyframe> keyframes(round().keyframes.begin(), round().keyframes.begin() + 20);
  const auto in_order = mapped(keyframes).snapshot();
  std::swap(keyframes[5], keyframes[12]);
  std::reverse(keyframes.begin() + 14, keyframes.end());
  const auto shuffled = mapped(keyframes).snapshot();
  EXPECT_EQ(shuffled->components, 1);
  ASSERT_EQ(shuffled->edges.size(), in_order->edges.size());
  for (std::size_t i = 0; i < in_order->nodes.size(); ++i) {
    EXPECT_EQ(in_order->nodes[i].keyframe->id, shuffled->nodes[i].keyframe->id);
    // Ends of an open chain: odometry alone places them.
    EXPECT_LT((in_order->nodes[i].T_map_camera.translation() -
               shuffled->nodes[i].T_map_camera.translation())
                  .norm(),
              1e-6);
  }
}

TEST(Backend, HoldsWhatFollowsAGapApartUntilTheGapIsFilled) {
  const std::vector<Keyframe>& keyframes = round().keyframes;
  Backend backend = mapped({keyframes[0], keyframes[1], keyframes[3], keyframes[4]});
  EXPECT_EQ(backend.snapshot()->components, 2);
  EXPECT_EQ(backend.insert(keyframes[2]).status, InsertionStatus::kInserted);
  EXPECT_EQ(backend.snapshot()->components, 1);
  EXPECT_EQ(backend.snapshot()->edges.size(), 4u);
}

TEST(Backend, IgnoresAKeyframeThatComesAgain) {
  Backend backend = mapped({round().keyframes[0], round().keyframes[1]});
  const auto before = backend.snapshot();
  EXPECT_EQ(backend.insert(round().keyframes[1]).status, InsertionStatus::kDuplicate);
  EXPECT_EQ(backend.snapshot(), before);
}

TEST(Backend, RefusesAMalformedKeyframeAndLosesNothing) {
  Backend backend = mapped({round().keyframes[0]});
  const auto before = backend.snapshot();
  Keyframe broken = round().keyframes[1];
  broken.planes.bytes.resize(broken.planes.bytes.size() / 2);
  const InsertionResult result = backend.insert(broken);
  EXPECT_EQ(result.status, InsertionStatus::kRefused);
  EXPECT_NE(result.reason.find("robot1/1/1"), std::string::npos) << result.reason;
  EXPECT_EQ(backend.snapshot(), before);
  EXPECT_EQ(backend.insert(round().keyframes[1]).status, InsertionStatus::kInserted);
}

TEST(Backend, TakesALaterSessionAsARestartAndTwoThatInterleaveAsANameClash) {
  Keyframe other = round().keyframes[0];
  other.id.session = 2;
  other.stamp = round().keyframes[2].stamp + 0.5;
  Backend backend = mapped({round().keyframes[0], round().keyframes[1], other});
  EXPECT_EQ(backend.snapshot()->components, 2);
  // Made before the restart, delivered after it.
  EXPECT_EQ(backend.insert(round().keyframes[2]).status, InsertionStatus::kInserted);
  const auto before = backend.snapshot();
  const InsertionResult result = backend.insert(round().keyframes[3]);
  EXPECT_EQ(result.status, InsertionStatus::kNameClash);
  EXPECT_NE(result.reason.find("sessions 1 and 2"), std::string::npos) << result.reason;
  EXPECT_EQ(backend.snapshot(), before);
}

/// Largest error of the position of a node relative to the one before it in the map [m].
double largestStepError(const MapSnapshot& map, const Truth& truth) {
  double largest = 0.0;
  for (std::size_t i = 1; i < map.nodes.size(); ++i) {
    const MapSnapshot::Node& a = map.nodes[i - 1];
    const MapSnapshot::Node& b = map.nodes[i];
    const Eigen::Isometry3d step = truth.at(a.keyframe->id).inverse() * truth.at(b.keyframe->id);
    const Eigen::Isometry3d mapped = a.T_map_camera.inverse() * b.T_map_camera;
    largest = std::max(largest, (step.inverse() * mapped).translation().norm());
  }
  return largest;
}

/// A map whose loop closes while it is optimised as a whole.
struct ClosedMeanwhile {
  Backend backend;
  std::optional<GraphOptimisation> meanwhile;

  explicit ClosedMeanwhile(const BackendOptions& options) : backend(options) {
    const std::vector<Keyframe>& keyframes = round().keyframes;
    std::size_t next = 0;
    for (; next + 10 < keyframes.size(); ++next) backend.insert(keyframes[next]);
    EXPECT_EQ(backend.statistics().closures_intra, 0u);
    meanwhile = backend.startOptimisation();
    for (; next < keyframes.size(); ++next) backend.insert(keyframes[next]);
    EXPECT_GE(backend.statistics().closures_intra, 2u);
    meanwhile->run();
  }
};

BackendOptions smallWindow() {
  BackendOptions options;
  options.graph.local_window = 25;
  return options;
}

TEST(Backend, KeepsTheLoopThatClosedDuringAnOptimisation) {
  ClosedMeanwhile closed(smallWindow());
  Backend& backend = closed.backend;
  const auto before = backend.snapshot();
  backend.finishOptimisation(*closed.meanwhile);
  const auto after = backend.snapshot();
  EXPECT_GT(after->revision, before->revision);
  EXPECT_LT(largestError(*after, round().truth), 1.1 * largestError(*before, round().truth));
  EXPECT_LT(largestStepError(*after, round().truth),
            largestStepError(*before, round().truth) + 0.005);
}

TEST(Backend, IgnoresAnOptimisationThatAnotherOneOvertook) {
  ClosedMeanwhile closed(smallWindow());
  Backend& backend = closed.backend;
  backend.optimize();
  const auto optimised = backend.snapshot();
  backend.finishOptimisation(*closed.meanwhile);
  EXPECT_EQ(backend.snapshot(), optimised);
}

TEST(Backend, SnapshotsStayWhatTheyWere) {
  Backend backend = mapped({round().keyframes[0]});
  const auto before = backend.snapshot();
  const std::uint64_t revision = before->revision;
  backend.insert(round().keyframes[1]);
  EXPECT_EQ(before->nodes.size(), 1u);
  EXPECT_GT(backend.snapshot()->revision, revision);
  backend.reset();
  EXPECT_TRUE(backend.snapshot()->nodes.empty());
  EXPECT_GT(backend.snapshot()->revision, revision);
  EXPECT_EQ(backend.insert(round().keyframes[0]).status, InsertionStatus::kInserted);
}

TEST(Backend, RefusesOptionsOutOfRangeByName) {
  BackendOptions options;
  options.loop_closure.verification.min_overlap = 1.5;
  try {
    const Backend backend(options);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "loop_closure/verification/min_overlap = 1.5: must be in [0, 1]");
  }
}

}  // namespace
}  // namespace planecloud
