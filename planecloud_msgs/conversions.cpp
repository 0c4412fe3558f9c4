// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/planecloud_msgs/conversions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "planecloud_slam/plane_fit/keyframe_rounding.h"
#include "planecloud_slam/planecloud_msgs/robot_name.h"

namespace planecloud {
namespace {

constexpr std::size_t kMaxReferences = 4096;      // edges or hints of one keyframe
constexpr std::size_t kMaxDescriptor = 1U << 16;  // [B]
constexpr double kMaxAngle = 3.1415930;           // pi as float32 may be above pi [rad]

/// Texture formats in the order of their numbers on the wire.
const std::array<std::string, 3> kTextureFormats = {"", "jpeg-grey", "jpeg-color"};

template <typename Floats>
void checkFinite(const Floats& values, const std::string& field) {
  for (const float value : values) {
    if (!std::isfinite(value)) refuseMessage(field + " has a number that is not finite");
  }
}

using WireVector = boost::array<float, 3>;

void writePose(const Eigen::Isometry3d& T, WireVector& translation, WireVector& rotation) {
  const PackedPose packed = packPose(T);
  std::copy_n(packed.begin(), 3, translation.begin());
  std::copy_n(packed.begin() + 3, 3, rotation.begin());
}

Eigen::Isometry3d readPose(const WireVector& translation, const WireVector& rotation,
                           const std::string& of) {
  checkFinite(translation, of + " translation");
  checkFinite(rotation, of + " rotation");
  const double angle = std::hypot(rotation[0], rotation[1], rotation[2]);
  if (angle > kMaxAngle) {
    refuseMessage(of + " rotation by " + std::to_string(angle) + " rad: must be at most pi");
  }
  return unpackPose(
      {translation[0], translation[1], translation[2], rotation[0], rotation[1], rotation[2]});
}

planecloud_slam::KeyframeReference writeReference(const KeyframeId& id, const KeyframeId& owner) {
  planecloud_slam::KeyframeReference reference;
  reference.id = id.number;
  if (id.robot != owner.robot || id.session != owner.session) {
    checkRobotName(id.robot);
    reference.session.resize(1);
    reference.session[0].robot = id.robot;
    reference.session[0].session = id.session;
  }
  return reference;
}

KeyframeId readReference(const planecloud_slam::KeyframeReference& reference,
                         const KeyframeId& owner, const std::string& field) {
  if (reference.session.size() > 1) {
    refuseMessage(field + " names " + std::to_string(reference.session.size()) +
                  " sessions: at most 1");
  }
  KeyframeId id{owner.robot, owner.session, reference.id};
  if (!reference.session.empty()) {
    id.robot = reference.session[0].robot;
    id.session = reference.session[0].session;
    if (!isRobotName(id.robot)) refuseMessage(field + ": " + robotNameError(id.robot));
  }
  if (id == owner) refuseMessage(field + " refers to the keyframe itself");
  return id;
}

planecloud_slam::RelativePoseEdge writeEdge(const RelativePoseEdge& edge, const KeyframeId& owner) {
  planecloud_slam::RelativePoseEdge message;
  message.other = writeReference(edge.other, owner);
  writePose(edge.T_other_this, message.translation, message.rotation);
  const PackedInformation packed = packInformation(edge.information);
  std::copy(packed.begin(), packed.end(), message.information.begin());
  return message;
}

RelativePoseEdge readEdge(const planecloud_slam::RelativePoseEdge& message, const KeyframeId& owner,
                          const std::string& field) {
  RelativePoseEdge edge;
  edge.other = readReference(message.other, owner, field);
  edge.T_other_this = readPose(message.translation, message.rotation, field);
  checkFinite(message.information, field + " information");
  PackedInformation packed;
  std::copy(message.information.begin(), message.information.end(), packed.begin());
  edge.information = unpackInformation(packed);
  return edge;
}

std::string numbered(const std::string& field, std::size_t index) {
  return field + "[" + std::to_string(index) + "]";
}

void checkCount(const std::string& field, std::size_t count, std::size_t most) {
  if (count <= most) return;
  refuseMessage(field + " has " + std::to_string(count) + " elements: at most " +
                std::to_string(most));
}

KeyframeTexture readTexture(const planecloud_slam::PlaneCloudKeyframe& message) {
  if (message.texture_format >= kTextureFormats.size()) {
    refuseMessage(
        "texture format " + std::to_string(message.texture_format) +
        " is unknown: must be 0 (none), 1 (grey JPEG) or 2 (colour JPEG); update this package");
  }
  if (message.texture.empty() != (message.texture_format == 0)) {
    refuseMessage("texture of format " + std::to_string(message.texture_format) + " has " +
                  std::to_string(message.texture.size()) + " bytes");
  }
  return {kTextureFormats[message.texture_format], message.texture};
}

std::uint8_t textureFormatNumber(const std::string& format) {
  const auto found = std::find(kTextureFormats.begin(), kTextureFormats.end(), format);
  if (found == kTextureFormats.end()) {
    throw std::invalid_argument("texture format '" + format +
                                "': must be '', 'jpeg-grey' or 'jpeg-color'");
  }
  return static_cast<std::uint8_t>(found - kTextureFormats.begin());
}

Keyframe readKeyframe(const planecloud_slam::PlaneCloudKeyframe& message, KeyframeId id) {
  Keyframe keyframe;
  keyframe.id = std::move(id);
  keyframe.stamp = message.plane_cloud.header.stamp.toSec();
  keyframe.T_odom_camera = readPose(message.translation, message.rotation, "odometry");
  keyframe.planes = fromMessage(message.plane_cloud);
  checkCount("edges", message.edges.size(), kMaxReferences);
  for (std::size_t i = 0; i < message.edges.size(); ++i) {
    keyframe.edges.push_back(readEdge(message.edges[i], keyframe.id, numbered("edge", i)));
  }
  checkCount("closure_hints", message.closure_hints.size(), kMaxReferences);
  for (std::size_t i = 0; i < message.closure_hints.size(); ++i) {
    keyframe.closure_hints.push_back(
        readReference(message.closure_hints[i], keyframe.id, numbered("closure hint", i)));
  }
  checkCount("descriptor", message.descriptor.size(), kMaxDescriptor);
  keyframe.descriptor = message.descriptor;
  keyframe.texture = readTexture(message);
  return keyframe;
}

}  // namespace

planecloud_slam::PlaneCloudKeyframe toMessage(const Keyframe& keyframe,
                                              const std::string& frame_id) {
  checkRobotName(keyframe.id.robot);
  planecloud_slam::PlaneCloudKeyframe message;
  message.robot = keyframe.id.robot;
  message.session = keyframe.id.session;
  message.id = keyframe.id.number;
  writePose(keyframe.T_odom_camera, message.translation, message.rotation);
  message.plane_cloud = toMessage(keyframe.planes, keyframe.stamp, frame_id);
  for (const RelativePoseEdge& edge : keyframe.edges) {
    message.edges.push_back(writeEdge(edge, keyframe.id));
  }
  for (const KeyframeId& hint : keyframe.closure_hints) {
    message.closure_hints.push_back(writeReference(hint, keyframe.id));
  }
  message.descriptor = keyframe.descriptor;
  message.texture_format = textureFormatNumber(keyframe.texture.format);
  message.texture = keyframe.texture.bytes;
  return message;
}

Keyframe fromMessage(const planecloud_slam::PlaneCloudKeyframe& message) {
  if (!isRobotName(message.robot))
    refuseMessage("keyframe refused: " + robotNameError(message.robot));
  const KeyframeId id{message.robot, message.session, message.id};
  try {
    return readKeyframe(message, id);
  } catch (const MessageError& error) {
    refuseMessage("keyframe " + toString(id) + " refused: " + error.what());
  }
}

}  // namespace planecloud
