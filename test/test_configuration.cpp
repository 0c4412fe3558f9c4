// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The files in config/ repeat the defaults of the code, so that a user can read and change them.
#include <gtest/gtest.h>

#include "planecloud_slam/backend_node/backend_node_options.h"
#include "planecloud_slam/frontend_node/frontend_node_options.h"
#include "planecloud_slam/rosbags/yaml_options.h"

namespace planecloud {
namespace {

template <typename Options>
void expectDefaults(const std::string& file) {
  const OptionValues defaults = dumpOptions(Options());
  const OptionValues values = readYamlOptions(std::string(PLANECLOUD_SLAM_CONFIG) + "/" + file);
  Options read;
  OptionValues left = values;
  takeOptions(left, read);
  EXPECT_EQ(left, OptionValues()) << "keys that no option has";
  EXPECT_NO_THROW(read.check());
  EXPECT_EQ(dumpOptions(read), defaults);
  EXPECT_EQ(values.size(), defaults.size());
  if (testing::Test::HasFailure()) {
    std::cout << "config/" << file << " should say:\n" << formatYamlOptions(defaults);
  }
}

TEST(Configuration, OfTheFrontendRepeatsTheDefaults) {
  expectDefaults<FrontendNodeOptions>("frontend.yaml");
}

TEST(Configuration, OfTheBackendRepeatsTheDefaults) {
  expectDefaults<BackendNodeOptions>("backend.yaml");
}

TEST(Configuration, FindsTheRobotsName) {
  EXPECT_EQ(robotName("ada", "/robot1"), "ada");
  EXPECT_EQ(robotName("", "/robot1"), "robot1");
  EXPECT_EQ(robotName("", "/team/robot1"), "team_robot1");
  EXPECT_EQ(robotName("", "/"), "robot");
}

TEST(Configuration, TakesTheTimeAsSessionUnlessToldOtherwise) {
  EXPECT_EQ(parseSession("", 5), 5U);
  EXPECT_EQ(parseSession("1700000000000000000", 5), 1700000000000000000U);
  EXPECT_THROW(static_cast<void>(parseSession("-1", 5)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(parseSession("0", 5)), std::invalid_argument);
}

TEST(Configuration, PutsTheRobotIntoTheNameOfItsFrame) {
  EXPECT_EQ(frameOfRobot("{robot}/odom", "ada"), "ada/odom");
  EXPECT_EQ(frameOfRobot("odom", "ada"), "odom");
}

}  // namespace
}  // namespace planecloud
