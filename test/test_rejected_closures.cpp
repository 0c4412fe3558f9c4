// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "planecloud_slam/backend_node/rejected_closures.h"

namespace planecloud {
namespace {

KeyframeId keyframe(std::size_t number) {
  return {"robot1", 1, static_cast<std::uint32_t>(number)};
}

TEST(RejectedClosures, CountsAllByReasonAndRemembersTheNewestPairs) {
  RejectedClosures rejected;
  constexpr std::size_t kPairs = RejectedClosures::kRemembered + 7;
  for (std::size_t i = 0; i < kPairs; ++i) {
    rejected.add({keyframe(i), keyframe(i + 50), i % 2 == 0 ? "seen_through" : "ambiguous"});
  }
  EXPECT_EQ(rejected.counts().at("seen_through") + rejected.counts().at("ambiguous"), kPairs);
  EXPECT_EQ(rejected.counts().at("ambiguous"), kPairs / 2);
  ASSERT_EQ(rejected.newest().size(), RejectedClosures::kRemembered);
  EXPECT_EQ(rejected.newest().front().from, keyframe(7));
  EXPECT_EQ(rejected.newest().back().to, keyframe(kPairs - 1 + 50));
  EXPECT_EQ(rejected.newest().back().reason, "seen_through");
}

TEST(RejectedClosures, NoClosuresLeaveNoReason) {
  RejectedClosures rejected;
  rejected.add({}, "no_witness");
  EXPECT_TRUE(rejected.counts().empty());
  GraphEdge closure;
  closure.from = keyframe(3);
  closure.to = keyframe(9);
  rejected.add({closure, closure}, "no_witness");
  EXPECT_EQ(rejected.counts().at("no_witness"), 2u);
  EXPECT_EQ(rejected.newest().front().from, keyframe(3));
}

}  // namespace
}  // namespace planecloud
