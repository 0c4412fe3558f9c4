// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/frame_stream.h"

#include <memory>
#include <utility>

#include "planecloud_slam/rosbags/read_ahead.h"

namespace planecloud {
namespace {

/// The streams' next steps, fetched when first asked for.
class StreamMerger {
 public:
  explicit StreamMerger(std::vector<FrameStream> streams)
      : streams_(std::move(streams)), heads_(streams_.size()) {}

  std::optional<ReplayedFrame> next() {
    if (!started_) {
      for (std::size_t i = 0; i < streams_.size(); ++i) heads_[i] = streams_[i]();
      started_ = true;
    }
    std::optional<std::size_t> earliest;
    for (std::size_t i = 0; i < heads_.size(); ++i) {
      if (heads_[i] && (!earliest || isBefore(*heads_[i], *heads_[*earliest]))) earliest = i;
    }
    if (!earliest) return std::nullopt;
    std::optional<ReplayedFrame> frame = std::move(heads_[*earliest]);
    heads_[*earliest] = streams_[*earliest]();
    return frame;
  }

 private:
  // Ties go by robot, so that the order does not depend on how streams were grouped.
  static bool isBefore(const ReplayedFrame& a, const ReplayedFrame& b) {
    return a.stamp < b.stamp || (a.stamp == b.stamp && a.robot < b.robot);
  }

  std::vector<FrameStream> streams_;
  std::vector<std::optional<ReplayedFrame>> heads_;
  bool started_ = false;
};

}  // namespace

FrameStream mergeByStamp(std::vector<FrameStream> streams) {
  if (streams.size() == 1) return std::move(streams.front());
  const auto merger = std::make_shared<StreamMerger>(std::move(streams));
  return [merger] { return merger->next(); };
}

FrameStream readAhead(FrameStream stream, std::size_t ahead) {
  const auto reader = std::make_shared<ReadAhead<ReplayedFrame>>(std::move(stream), ahead);
  return [reader] { return reader->next(); };
}

}  // namespace planecloud
