// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/keyframe_wire_size.h"

namespace planecloud {
namespace {

constexpr std::size_t kLength = 4;  // before every string and every array of variable length
constexpr std::size_t kFloat = 4;
constexpr std::size_t kPose = 6 * kFloat;
constexpr std::size_t kSession = 8;
constexpr std::size_t kNumber = 4;

std::size_t referenceSize(const KeyframeId& id, const KeyframeId& owner) {
  const bool same_session = id.robot == owner.robot && id.session == owner.session;
  return kLength + (same_session ? 0 : kLength + id.robot.size() + kSession) + kNumber;
}

std::size_t planeCloudSize(const EncodedPlaneCloud& planes, const std::string& frame_id) {
  const std::size_t header = 4 + 8 + kLength + frame_id.size();  // sequence number, stamp, frame
  const std::size_t distortion = planes.camera.hasDistortion() ? 5 * kFloat : 0;
  const std::size_t camera = 4 * kFloat + kLength + distortion + 2 + 2;
  const std::size_t coded = 1 + 4 + kLength + planes.bytes.size();  // encoding, plane count
  const std::size_t statistics = 4 * 2 + 1;
  return header + camera + coded + statistics;
}

}  // namespace

std::size_t keyframeWireSize(const Keyframe& keyframe, const std::string& frame_id) {
  const KeyframeId& id = keyframe.id;
  std::size_t size = kLength + id.robot.size() + kSession + kNumber + kPose;
  size += planeCloudSize(keyframe.planes, frame_id);
  size += kLength;
  for (const RelativePoseEdge& edge : keyframe.edges) {
    size += referenceSize(edge.other, id) + kPose + 21 * kFloat;
  }
  size += kLength;
  for (const KeyframeId& hint : keyframe.closure_hints) size += referenceSize(hint, id);
  size += kLength + keyframe.descriptor.size();
  size += 1 + kLength + keyframe.texture.bytes.size();
  return size;
}

}  // namespace planecloud
