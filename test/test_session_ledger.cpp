// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>

#include "planecloud_slam/backend_node/session_ledger.h"

namespace planecloud {
namespace {

Keyframe keyframeOf(std::uint64_t session, std::uint32_t number, double stamp) {
  Keyframe keyframe;
  keyframe.id = {"robot1", session, number};
  keyframe.stamp = stamp;
  return keyframe;
}

TEST(SessionLedger, TakesALaterSessionForARestart) {
  SessionLedger ledger;
  ledger.record(keyframeOf(1, 0, 10.0));
  ledger.record(keyframeOf(1, 1, 11.0));
  EXPECT_EQ(ledger.clash(keyframeOf(2, 0, 20.0)), "");
  ledger.record(keyframeOf(2, 0, 20.0));
  EXPECT_EQ(ledger.clash(keyframeOf(2, 1, 21.0)), "");
}

TEST(SessionLedger, NamesBothSessionsThatGoOnAtOnce) {
  SessionLedger ledger;
  ledger.record(keyframeOf(1, 0, 10.0));
  ledger.record(keyframeOf(2, 0, 20.0));
  const std::string clash = ledger.clash(keyframeOf(1, 1, 20.5));
  EXPECT_NE(clash.find("robot1/1/1"), std::string::npos) << clash;
  EXPECT_NE(clash.find("sessions 1 and 2"), std::string::npos) << clash;
  EXPECT_NE(clash.find("own name"), std::string::npos) << clash;
}

TEST(SessionLedger, TakesWhatTheOldSessionMadeBeforeTheRestartHoweverLate) {
  SessionLedger ledger;
  ledger.record(keyframeOf(1, 0, 10.0));
  ledger.record(keyframeOf(2, 0, 20.0));
  EXPECT_EQ(ledger.clash(keyframeOf(1, 1, 19.0)), "");
}

TEST(SessionLedger, TakesAFilledGapEvenWhenStampsRanBackBetweenSessions) {
  SessionLedger ledger;  // a recording played twice: the second session has the same stamps
  ledger.record(keyframeOf(1, 0, 10.0));
  ledger.record(keyframeOf(1, 2, 12.0));
  ledger.record(keyframeOf(2, 0, 10.0));
  EXPECT_EQ(ledger.clash(keyframeOf(1, 1, 11.0)), "");
}

TEST(SessionLedger, KnowsRobotsApart) {
  SessionLedger ledger;
  ledger.record(keyframeOf(2, 0, 20.0));
  Keyframe other = keyframeOf(1, 1, 30.0);
  other.id.robot = "robot2";
  EXPECT_EQ(ledger.clash(other), "");
}

}  // namespace
}  // namespace planecloud
