// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <stdexcept>

#include "planecloud_slam/rosbags/frame_stream.h"
#include "planecloud_slam/rosbags/read_ahead.h"

namespace planecloud {
namespace {

FrameStream stampsOf(std::size_t robot, std::vector<double> stamps) {
  std::size_t next = 0;
  return [=]() mutable -> std::optional<ReplayedFrame> {
    if (next == stamps.size()) return std::nullopt;
    ReplayedFrame frame;
    frame.robot = robot;
    frame.stamp = stamps[next++];
    return frame;
  };
}

std::vector<std::pair<double, std::size_t>> drain(const FrameStream& stream) {
  std::vector<std::pair<double, std::size_t>> frames;
  while (const auto frame = stream()) frames.emplace_back(frame->stamp, frame->robot);
  return frames;
}

std::vector<FrameStream> threeStreams() {
  std::vector<FrameStream> streams;
  streams.push_back(stampsOf(0, {1.0, 2.0, 9.0, 3.0}));  // time jumps back at the end
  streams.push_back(stampsOf(1, {1.0, 1.5, 2.0}));
  streams.push_back(stampsOf(2, {0.5, 2.0, 2.5, 4.0}));
  return streams;
}

TEST(FrameStream, MergesByStampAndThenByRobot) {
  const std::vector<std::pair<double, std::size_t>> expected = {
      {0.5, 2}, {1.0, 0}, {1.0, 1}, {1.5, 1}, {2.0, 0}, {2.0, 1},
      {2.0, 2}, {2.5, 2}, {4.0, 2}, {9.0, 0}, {3.0, 0}};
  EXPECT_EQ(drain(mergeByStamp(threeStreams())), expected);
}

TEST(FrameStream, GroupingAndReadingAheadDoNotChangeTheOrder) {
  const auto expected = drain(mergeByStamp(threeStreams()));
  std::vector<FrameStream> streams = threeStreams();
  std::vector<FrameStream> first_group;
  first_group.push_back(std::move(streams[0]));
  first_group.push_back(std::move(streams[2]));
  std::vector<FrameStream> groups;
  groups.push_back(readAhead(mergeByStamp(std::move(first_group)), 2));
  groups.push_back(readAhead(std::move(streams[1]), 2));
  EXPECT_EQ(drain(mergeByStamp(std::move(groups))), expected);
}

TEST(ReadAhead, PassesAnExceptionOnAfterTheItemsBeforeIt) {
  int count = 0;
  ReadAhead<int> reader(
      [&]() -> std::optional<int> {
        if (count == 3) throw std::runtime_error("end of tape");
        return count++;
      },
      8);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(reader.next(), i);
  EXPECT_THROW((void)reader.next(), std::runtime_error);
}

TEST(ReadAhead, CanBeLeftBeforeTheEnd) {
  int count = 0;
  ReadAhead<int> reader([&]() -> std::optional<int> { return count++; }, 2);
  EXPECT_EQ(reader.next(), 0);
}

}  // namespace
}  // namespace planecloud
