// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <set>

#include "planecloud_slam/frontend_node/outbox.h"

namespace planecloud {
namespace {

constexpr std::uint64_t kSession = 7;
constexpr std::size_t kKeyframeBytes = 10'000;

std::shared_ptr<const Keyframe> makeKeyframe(std::uint32_t number) {
  auto keyframe = std::make_shared<Keyframe>();
  keyframe->id = {"robot", kSession, number};
  return keyframe;
}

Outbox makeOutbox(const LinkOptions& options = {}) { return {options, "robot", kSession}; }

KeyframeReceipt receipt(std::int64_t highest, std::int64_t last = -1,
                        std::vector<std::uint32_t> gaps = {}) {
  return {"backend", "robot", kSession, highest, std::max(highest, last), std::move(gaps)};
}

std::vector<std::uint32_t> numbers(const std::vector<std::shared_ptr<const Keyframe>>& keyframes) {
  std::vector<std::uint32_t> result;
  for (const auto& keyframe : keyframes) result.push_back(keyframe->id.number);
  return result;
}

using Numbers = std::vector<std::uint32_t>;

TEST(Outbox, SendsNothingAgainWhileAcknowledgementsKeepUp) {
  Outbox outbox = makeOutbox();
  for (std::uint32_t i = 0; i < 50; ++i) {
    outbox.add(makeKeyframe(i), kKeyframeBytes, i);
    if (i >= 2) outbox.acknowledge(receipt(i - 2), i + 0.1);
    EXPECT_TRUE(outbox.takeDue(i + 0.2).empty());
  }
  EXPECT_EQ(outbox.unacknowledged(), 2U);
}

TEST(Outbox, ResendsAGapAsSoonAsSomethingSentLaterArrived) {
  Outbox outbox = makeOutbox();
  outbox.acknowledge(receipt(-1), 0.0);
  for (std::uint32_t i = 0; i < 6; ++i) outbox.add(makeKeyframe(i), kKeyframeBytes, 1.0);
  outbox.acknowledge(receipt(1, 3, {2}), 1.1);
  EXPECT_EQ(numbers(outbox.takeDue(1.2)), Numbers{2});
  EXPECT_TRUE(outbox.takeDue(1.4).empty()) << "it is on its way, as are 4 and 5";
}

TEST(Outbox, ResendsTheTailAfterATimeWithoutProgress) {
  Outbox outbox = makeOutbox();
  outbox.add(makeKeyframe(0), kKeyframeBytes, 0.0);
  outbox.acknowledge(receipt(0), 0.1);
  EXPECT_TRUE(outbox.takeDue(100.0).empty());
  outbox.acknowledge(receipt(0), 100.0);
  EXPECT_TRUE(outbox.takeDue(100.0).empty());
  outbox.add(makeKeyframe(1), kKeyframeBytes, 100.0);
  outbox.acknowledge(receipt(0), 102.0);
  EXPECT_TRUE(outbox.takeDue(102.0).empty());
  outbox.acknowledge(receipt(0), 104.0);
  EXPECT_EQ(numbers(outbox.takeDue(104.0)), Numbers{1});
}

TEST(Outbox, IsMorePatientEachTimeNothingHelps) {
  Outbox outbox = makeOutbox();
  outbox.acknowledge(receipt(-1), 0.0);
  outbox.add(makeKeyframe(0), kKeyframeBytes, 0.0);
  std::vector<double> resends;
  for (double now = 0.0; now < 100.0; now += 0.5) {
    outbox.acknowledge(receipt(-1), now);
    if (!outbox.takeDue(now).empty()) resends.push_back(now);
  }
  ASSERT_GE(resends.size(), 4U);
  EXPECT_LE(resends.size(), 7U);
  EXPECT_GT(resends[2] - resends[1], resends[1] - resends[0]);
  EXPECT_LE(resends.back() - resends[resends.size() - 2], 8 * LinkOptions().resend_after + 1.0);
}

TEST(Outbox, GivesARestartedBackendEverythingAgain) {
  Outbox outbox = makeOutbox();
  for (std::uint32_t i = 0; i < 5; ++i) outbox.add(makeKeyframe(i), kKeyframeBytes, 0.0);
  outbox.acknowledge(receipt(4), 1.0);
  outbox.acknowledge({"backend", "", 0, -1, -1, {}}, 10.0);
  EXPECT_EQ(numbers(outbox.takeDue(10.1)), (Numbers{0, 1, 2, 3, 4}));
}

TEST(Outbox, NoticesARestartByWhatIsMissingToo) {
  Outbox outbox = makeOutbox();
  for (std::uint32_t i = 0; i < 5; ++i) outbox.add(makeKeyframe(i), kKeyframeBytes, 0.0);
  outbox.acknowledge(receipt(3), 1.0);
  outbox.acknowledge(receipt(-1, 4, {0, 1, 2, 3}), 10.0);
  EXPECT_EQ(numbers(outbox.takeDue(10.1)), (Numbers{0, 1, 2, 3}));
}

TEST(Outbox, GivesABackendThatIsNewEverythingAgain) {
  Outbox outbox = makeOutbox();
  for (std::uint32_t i = 0; i < 5; ++i) outbox.add(makeKeyframe(i), kKeyframeBytes, 0.0);
  outbox.acknowledge(receipt(4), 1.0);
  outbox.acknowledge({"another", "", 0, -1, -1, {}}, 10.0);
  EXPECT_EQ(numbers(outbox.takeDue(10.1)), (Numbers{0, 1, 2, 3, 4}));
}

TEST(Outbox, TakesAReceiptForAnotherSessionAsHavingNothingOfThisOne) {
  Outbox outbox = makeOutbox();
  outbox.add(makeKeyframe(0), kKeyframeBytes, 0.0);
  outbox.acknowledge({"backend", "robot", kSession - 1, 20, 20, {}}, 1.0);
  EXPECT_EQ(numbers(outbox.takeDue(1.1)), Numbers{0});
  outbox.acknowledge(receipt(0), 2.0);
  outbox.acknowledge({"backend", "robot", kSession - 1, 20, 20, {}}, 2.0);
  EXPECT_EQ(outbox.unacknowledged(), 0U);
}

TEST(Outbox, LimitsWhatIsUnderWayToTheWindow) {
  LinkOptions options;
  options.resend_window = 3.5 * kKeyframeBytes;
  Outbox outbox = makeOutbox(options);
  for (std::uint32_t i = 0; i < 10; ++i) outbox.add(makeKeyframe(i), kKeyframeBytes, 0.0);
  outbox.acknowledge(receipt(-1), 5.0);
  EXPECT_EQ(numbers(outbox.takeDue(5.1)), (Numbers{0, 1, 2}));
  EXPECT_TRUE(outbox.takeDue(5.2).empty());
  outbox.acknowledge(receipt(1), 5.3);
  EXPECT_EQ(numbers(outbox.takeDue(5.4)), (Numbers{3, 4}));
}

TEST(Outbox, SendsNothingIntoALinkThatIsDown) {
  Outbox outbox = makeOutbox();
  outbox.acknowledge(receipt(-1), 0.0);
  outbox.add(makeKeyframe(0), kKeyframeBytes, 0.0);
  EXPECT_TRUE(outbox.takeDue(60.0).empty());
  outbox.acknowledge(receipt(-1), 61.0);
  EXPECT_TRUE(outbox.takeDue(61.1).empty()) << "what the link still holds may come now";
  outbox.acknowledge(receipt(-1), 63.0);
  outbox.acknowledge(receipt(-1), 64.5);
  EXPECT_EQ(numbers(outbox.takeDue(64.5)), Numbers{0});
}

TEST(Outbox, ResendsThoughReceiptsAreRare) {
  Outbox outbox = makeOutbox();
  outbox.acknowledge(receipt(-1), 0.0);
  outbox.add(makeKeyframe(0), kKeyframeBytes, 0.0);
  std::size_t resends = 0;
  for (double now = 5.0; now < 60.0; now += 5.0) {
    outbox.acknowledge(receipt(-1), now);
    resends += outbox.takeDue(now + 0.1).size();
  }
  EXPECT_GE(resends, 2U);
}

TEST(Outbox, KeepsWhatABackendHeardLatelyLacksAndForgetsHistoryFirst) {
  LinkOptions options;
  options.outbox_bytes = 3.5 * kKeyframeBytes;
  options.backend_timeout = 100.0;
  Outbox outbox = makeOutbox(options);
  outbox.acknowledge(receipt(-1), 0.0);
  for (std::uint32_t i = 0; i < 10; ++i) outbox.add(makeKeyframe(i), kKeyframeBytes, 1.0);
  EXPECT_EQ(outbox.statistics().stored, 10U);
  outbox.acknowledge(receipt(7), 2.0);
  EXPECT_EQ(outbox.statistics().stored, 3U);
  EXPECT_EQ(outbox.statistics().forgotten, 7U);
  EXPECT_EQ(outbox.statistics().given_up, 0U);
}

TEST(Outbox, CountsWhatItGivesUp) {
  LinkOptions options;
  options.outbox_bytes = 3.5 * kKeyframeBytes;
  options.backend_timeout = 100.0;
  Outbox outbox = makeOutbox(options);
  outbox.acknowledge(receipt(-1), 0.0);
  for (std::uint32_t i = 0; i < 10; ++i) outbox.add(makeKeyframe(i), kKeyframeBytes, 1.0);
  EXPECT_EQ(outbox.statistics().given_up, 0U);
  EXPECT_TRUE(outbox.takeDue(200.0).empty());
  EXPECT_EQ(outbox.statistics().backends, 0U);
  EXPECT_EQ(outbox.statistics().given_up, 7U);
}

TEST(Outbox, KeepsNothingWithoutAcknowledgements) {
  LinkOptions options;
  options.acknowledge = false;
  Outbox outbox = makeOutbox(options);
  outbox.add(makeKeyframe(0), kKeyframeBytes, 0.0);
  outbox.acknowledge(receipt(-1), 1.0);
  EXPECT_TRUE(outbox.takeDue(10.0).empty());
  EXPECT_EQ(outbox.statistics().stored, 0U);
}

TEST(Outbox, RefusesNumbersThatDoNotAscendAndOptionsOutOfRange) {
  Outbox outbox = makeOutbox();
  outbox.add(makeKeyframe(3), kKeyframeBytes, 0.0);
  EXPECT_THROW(outbox.add(makeKeyframe(3), kKeyframeBytes, 0.0), std::invalid_argument);
  LinkOptions options;
  options.resend_window = 10.0;
  EXPECT_THROW(makeOutbox(options), std::invalid_argument);
}

/// A link of 125 kB/s that delivers in order, loses what is under way when it breaks and carries
/// receipts back; a backend behind it.
class SimulatedLink {
 public:
  void send(std::uint32_t number) {
    if (up_) under_way_.push_back(number);
    sent_bytes_ += kKeyframeBytes;
  }
  void setUp(bool up) {
    up_ = up;
    if (!up) under_way_.clear();
  }
  void restartBackend() { there_.clear(); }
  void advance(double seconds) {
    credit_ = up_ && !under_way_.empty() ? credit_ + 125e3 * seconds : 0.0;
    for (; credit_ >= kKeyframeBytes && !under_way_.empty(); credit_ -= kKeyframeBytes) {
      there_.insert(under_way_.front());
      under_way_.pop_front();
    }
  }
  [[nodiscard]] bool up() const { return up_; }
  [[nodiscard]] std::size_t arrived() const { return there_.size(); }
  [[nodiscard]] std::size_t sentBytes() const { return sent_bytes_; }
  [[nodiscard]] KeyframeReceipt receipt() const {
    KeyframeReceipt result{"backend", "robot", kSession, -1, -1, {}};
    if (there_.empty()) return {"backend", "", 0, -1, -1, {}};
    result.last = *there_.rbegin();
    for (std::int64_t i = 0; i <= result.last; ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      if (there_.count(number) == 0) {
        result.gaps.push_back(number);
      } else if (result.highest == i - 1) {
        result.highest = i;
      }
    }
    return result;
  }

 private:
  bool up_ = true;
  double credit_ = 0.0;
  std::size_t sent_bytes_ = 0;
  std::deque<std::uint32_t> under_way_;
  std::set<std::uint32_t> there_;
};

TEST(Outbox, LosesNothingOverASlowLinkThatBreaksOnABackendThatRestarts) {
  Outbox outbox = makeOutbox();
  SimulatedLink link;
  constexpr std::uint32_t kCount = 600;
  std::uint32_t next = 0;
  std::size_t bytes_before_restart = 0;
  for (int step = 0; step < 4000; ++step) {  // 0.1 s each
    const double now = 0.1 * step;
    if (step % 5 == 0 && next < kCount) {
      outbox.add(makeKeyframe(next), kKeyframeBytes, now);
      link.send(next++);
    }
    if (step == 500) link.setUp(false);
    if (step == 1100) link.setUp(true);
    if (step == 2500) bytes_before_restart = link.sentBytes();
    if (step == 2500) link.restartBackend();
    link.advance(0.1);
    if (step % 3 == 0 && link.up()) outbox.acknowledge(link.receipt(), now);
    if (step % 2 == 0) {
      for (const auto& keyframe : outbox.takeDue(now)) link.send(keyframe->id.number);
    }
  }
  EXPECT_EQ(link.arrived(), kCount);
  EXPECT_EQ(outbox.unacknowledged(), 0U);
  // Before the restart: each of 500 keyframes once, and the 120 of the broken minute once more.
  EXPECT_LE(bytes_before_restart, (500 + 130) * kKeyframeBytes);
  EXPECT_LE(link.sentBytes() - bytes_before_restart, (600 + 20) * kKeyframeBytes);
}

}  // namespace
}  // namespace planecloud
