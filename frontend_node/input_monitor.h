// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace planecloud {

/// Watches what arrives and says, in words that name the cure, why no frames come of it. Stamps are
/// those of the messages, `now` is any clock that never goes back, both [s]. No threads, no clock.
class InputMonitor {
 public:
  enum Topic { kColor = 0, kDepth = 1, kCameraInfo = 2 };
  static constexpr std::size_t kTopics = 3;

  /// `names`: resolved topic names in the order of `Topic`.
  InputMonitor(std::array<std::string, kTopics> names, double now);

  /// A message arrived. True when time went back by more than a second: a bag began again.
  bool noteMessage(Topic topic, double stamp);
  /// A colour and a depth image were paired.
  void notePair() { ++pairs_; }

  /// What has been wrong since the last call, empty when nothing was: topics that were silent or
  /// images that never paired, with rates and the offset of their stamps.
  [[nodiscard]] std::string takeProblem(double now);

  /// Messages per second of a topic between the last two calls of `takeProblem`.
  [[nodiscard]] double rate(Topic topic) const { return topics_.at(topic).rate; }

 private:
  struct TopicState {
    std::string name;
    std::size_t count = 0;  ///< since `takeProblem`
    std::size_t total = 0;
    double rate = 0.0;        ///< [Hz]
    double last_stamp = 0.0;  ///< [s]
  };

  [[nodiscard]] std::string describeRates() const;
  [[nodiscard]] std::string describeSilence() const;
  [[nodiscard]] std::string describeMismatch() const;

  std::array<TopicState, kTopics> topics_;
  std::size_t pairs_ = 0;
  double newest_stamp_ = 0.0;
  double since_;
};

}  // namespace planecloud
