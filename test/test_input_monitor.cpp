// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planecloud_slam/frontend_node/input_monitor.h"

namespace planecloud {
namespace {

using testing::HasSubstr;
using testing::Not;

InputMonitor makeMonitor() { return {{"/rgb", "/depth", "/info"}, 0.0}; }

TEST(InputMonitor, NamesSilentTopicsAndTheRatesOfTheOthers) {
  InputMonitor monitor = makeMonitor();
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(monitor.noteMessage(InputMonitor::kColor, 0.1 * i));
  const std::string problem = monitor.takeProblem(5.0);
  EXPECT_THAT(problem, HasSubstr("no messages on /depth and /info"));
  EXPECT_THAT(problem, HasSubstr("/rgb 10.0 Hz"));
  EXPECT_THAT(problem, HasSubstr("remap"));
}

TEST(InputMonitor, IsContentWithOneCameraInfoAndPairs) {
  InputMonitor monitor = makeMonitor();
  monitor.noteMessage(InputMonitor::kCameraInfo, 0.0);
  for (int round = 1; round < 4; ++round) {
    monitor.noteMessage(InputMonitor::kColor, round);
    monitor.noteMessage(InputMonitor::kDepth, round);
    monitor.notePair();
    EXPECT_EQ(monitor.takeProblem(5.0 * round), "");
  }
}

TEST(InputMonitor, TellsTheOffsetOfStampsThatNeverPair) {
  InputMonitor monitor = makeMonitor();
  monitor.noteMessage(InputMonitor::kCameraInfo, 0.0);
  for (int i = 0; i < 10; ++i) {
    monitor.noteMessage(InputMonitor::kColor, 0.5 * i);
    monitor.noteMessage(InputMonitor::kDepth, 0.5 * i + 0.25);
  }
  const std::string problem = monitor.takeProblem(5.0);
  EXPECT_THAT(problem, HasSubstr("never pair up"));
  EXPECT_THAT(problem, HasSubstr("0.250 s apart"));
  EXPECT_THAT(problem, HasSubstr("~exact_sync"));
}

TEST(InputMonitor, DoesNotJudgePairsByAFewImages) {
  InputMonitor monitor = makeMonitor();
  monitor.noteMessage(InputMonitor::kCameraInfo, 0.0);
  monitor.noteMessage(InputMonitor::kColor, 0.0);
  monitor.noteMessage(InputMonitor::kDepth, 0.0);
  EXPECT_EQ(monitor.takeProblem(5.0), "");
}

TEST(InputMonitor, NoticesThatABagBeganAgainOnce) {
  InputMonitor monitor = makeMonitor();
  EXPECT_FALSE(monitor.noteMessage(InputMonitor::kColor, 100.0));
  EXPECT_FALSE(monitor.noteMessage(InputMonitor::kDepth, 99.9)) << "a little late is no jump";
  EXPECT_TRUE(monitor.noteMessage(InputMonitor::kDepth, 10.0));
  EXPECT_FALSE(monitor.noteMessage(InputMonitor::kColor, 10.0));
}

}  // namespace
}  // namespace planecloud
