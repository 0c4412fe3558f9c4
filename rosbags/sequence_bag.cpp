// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/sequence_bag.h"

#include "planecloud_slam/rosbags/bag_writer.h"

namespace planecloud {

void writeSequenceBag(const SequenceFolder& folder, const std::string& path,
                      const std::function<void()>& progress) {
  BagWriter bag(path);
  const CameraTopics topics = rawTopics();
  for (const StampedPose& truth : folder.ground_truth) bag.writeGroundTruth("/ground_truth", truth);
  for (const SequencePair& pair : folder.pairs) {
    const SequenceImages images = readSequenceImages(folder, pair);
    const ros::Time color_stamp = toRosTime(pair.color_stamp);
    bag.writeCameraInfo(topics, folder.camera, color_stamp);
    bag.writeColor(topics, images.color, color_stamp);
    bag.writeDepth(topics, images.depth, toRosTime(pair.depth_stamp));
    if (progress) progress();
  }
  bag.close();
}

}  // namespace planecloud
