// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/backend_node/ack_tracker.h"

namespace planecloud {
namespace {

KeyframeId id(std::uint32_t number, std::uint64_t session = 7) {
  return {"robot", session, number};
}

void settleAll(AckTracker& tracker, const std::vector<std::uint32_t>& numbers) {
  for (const std::uint32_t number : numbers) {
    tracker.noteArrival(id(number));
    tracker.settle(id(number));
  }
}

TEST(AckTracker, TellsGapsBetweenTheContiguousAndTheHighest) {
  AckTracker tracker;
  settleAll(tracker, {0, 1, 3, 6});
  ASSERT_EQ(tracker.receipts().size(), 1U);
  const SessionReceipt receipt = tracker.receipts().front();
  EXPECT_EQ(receipt.robot, "robot");
  EXPECT_EQ(receipt.session, 7U);
  EXPECT_EQ(receipt.highest_without_gap, 1);
  EXPECT_EQ(receipt.highest, 6);
  EXPECT_EQ(receipt.gaps, (std::vector<std::uint32_t>{2, 4, 5}));
  EXPECT_EQ(tracker.missing(), 3U);
}

TEST(AckTracker, ClosesGapsWhateverTheOrder) {
  AckTracker tracker;
  settleAll(tracker, {4, 2, 0, 1, 3});
  EXPECT_EQ(tracker.receipts().front().highest_without_gap, 4);
  EXPECT_TRUE(tracker.receipts().front().gaps.empty());
  EXPECT_EQ(tracker.missing(), 0U);
}

TEST(AckTracker, AcknowledgesOnlyWhatIsSettled) {
  AckTracker tracker;
  EXPECT_TRUE(tracker.noteArrival(id(0)));
  EXPECT_TRUE(tracker.receipts().empty());
  tracker.settle(id(0));
  EXPECT_EQ(tracker.receipts().front().highest_without_gap, 0);
}

TEST(AckTracker, KnowsTheHighestThatArrived) {
  AckTracker tracker;
  EXPECT_EQ(tracker.highestArrived(id(0)), -1);
  settleAll(tracker, {0, 4});
  EXPECT_EQ(tracker.highestArrived(id(0)), 4);
  tracker.noteArrival(id(9));
  EXPECT_EQ(tracker.highestArrived(id(0)), 9);
}

TEST(AckTracker, NoticesRepetitions) {
  AckTracker tracker;
  EXPECT_TRUE(tracker.noteArrival(id(5)));
  EXPECT_FALSE(tracker.noteArrival(id(5)));
  tracker.settle(id(5));
  EXPECT_FALSE(tracker.noteArrival(id(5)));
  EXPECT_TRUE(tracker.noteArrival(id(5, 8))) << "another session is another keyframe";
}

TEST(AckTracker, TellsNoMoreGapsThanTheMessageShouldCarry) {
  AckTracker tracker;
  settleAll(tracker, {4'000'000'000U});
  const SessionReceipt receipt = tracker.receipts().front();
  EXPECT_EQ(receipt.gaps.size(), AckTracker::kMaxGaps);
  EXPECT_EQ(receipt.highest_without_gap, -1);
  EXPECT_EQ(receipt.highest, 255);
}

}  // namespace
}  // namespace planecloud
