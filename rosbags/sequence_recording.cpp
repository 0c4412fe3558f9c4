// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/sequence_recording.h"

#include <utility>

namespace planecloud {

SequenceRecording::SequenceRecording(SequenceFolder folder, std::string robot)
    : folder_(std::move(folder)), robot_(std::move(robot)) {}

std::optional<RgbdFrame> SequenceRecording::next() {
  if (position_ == folder_.pairs.size()) return std::nullopt;
  const SequencePair& pair = folder_.pairs[position_++];
  SequenceImages images = readSequenceImages(folder_, pair);
  RgbdFrame frame;
  frame.stamp = pair.depth_stamp;
  frame.color_delay = pair.color_stamp - pair.depth_stamp;
  frame.grey = greyFromColor(images.color);
  frame.depth = std::move(images.depth);
  color_ = std::move(images.color);
  return frame;
}

}  // namespace planecloud
