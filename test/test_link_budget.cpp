// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "planecloud_slam/frontend_node/link_budget.h"

namespace planecloud {
namespace {

struct Message {
  double time;
  std::size_t bytes;
};

/// Most bytes in any window that ends with a message [B].
std::size_t fullestWindow(const std::vector<Message>& messages) {
  std::size_t fullest = 0;
  for (const Message& last : messages) {
    std::size_t bytes = 0;
    for (const Message& message : messages) {
      const bool inside =
          message.time <= last.time && message.time >= last.time - LinkBudget::kWindow;
      if (inside) bytes += message.bytes;
    }
    fullest = std::max(fullest, bytes);
  }
  return fullest;
}

/// Offers random messages, half of them in bursts, and sends each as soon as it is admitted.
std::vector<Message> sendAll(LinkBudget& budget, unsigned seed, int count, std::size_t largest) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::size_t> sizes(100, largest);
  std::exponential_distribution<double> pauses(2.0);
  std::vector<Message> sent;
  double now = 1000.0;
  for (int i = 0; i < count; ++i) {
    if (random() % 2 == 0) now += pauses(random);
    const std::size_t bytes = sizes(random);
    while (!budget.admits(bytes, now)) now += 0.05;
    budget.spend(bytes, now);
    sent.push_back({now, bytes});
  }
  return sent;
}

TEST(LinkBudget, HoldsInEveryWindow) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    LinkBudget budget(2000.0);
    EXPECT_LE(fullestWindow(sendAll(budget, seed, 400, 4000)), 10'000U) << "seed " << seed;
  }
}

TEST(LinkBudget, UsesMostOfTheRateWhenThereIsEnoughToSend) {
  LinkBudget budget(2000.0);
  std::size_t total = 0;
  double now = 0.0;
  while (now < 100.0) {
    if (!budget.admits(1000, now)) {
      now += 0.05;
      continue;
    }
    budget.spend(1000, now);
    total += 1000;
  }
  EXPECT_GE(static_cast<double>(total), 0.95 * 2000.0 * now);
}

TEST(LinkBudget, SendsAtOnceWithoutALimit) {
  LinkBudget budget;
  budget.spend(1'000'000, 0.0);
  EXPECT_EQ(budget.available(0.0), LinkBudget::kUnlimited);
  EXPECT_TRUE(budget.admits(1'000'000'000, 0.0));
}

TEST(LinkBudget, FollowsANewRateAtOnce) {
  LinkBudget budget(10'000.0);
  budget.spend(20'000, 0.0);
  EXPECT_EQ(budget.available(0.1), 30'000U);
  budget.setRate(4000.0);
  EXPECT_EQ(budget.available(0.1), 0U);
  EXPECT_FALSE(budget.admits(1, 4.9));
  EXPECT_EQ(budget.available(5.1), 20'000U);
}

TEST(LinkBudget, LetsWhatNoWindowHoldsGoAlone) {
  LinkBudget budget(100.0);
  budget.spend(100, 0.0);
  EXPECT_FALSE(budget.admits(1000, 4.0));
  EXPECT_TRUE(budget.admits(1000, 5.1));
  budget.spend(1000, 5.1);
  EXPECT_FALSE(budget.admits(1, 9.0));
}

}  // namespace
}  // namespace planecloud
