// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <planecloud_slam/ExportMap.h>
#include <planecloud_slam/KeyframeAck.h>
#include <ros/message_traits.h>
#include <ros/service_traits.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <new>
#include <random>

#include "known_keyframe.h"
#include "planecloud_slam/plane_fit/keyframe_rounding.h"

namespace planecloud {
namespace {

std::vector<std::uint8_t> fixture(const std::string& name) {
  std::ifstream file(PLANECLOUD_SLAM_FIXTURES "/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Bytes of a keyframe with `edges` edges to its own session that are not planes, texture or
/// descriptor.
std::size_t overhead(std::size_t edges) {
  Keyframe keyframe = knownKeyframe();
  keyframe.closure_hints.clear();
  keyframe.planes.camera.distortion = {};
  keyframe.edges.resize(1);
  keyframe.edges.resize(edges, keyframe.edges[0]);
  const planecloud_slam::PlaneCloudKeyframe message = toMessage(keyframe, kKnownFrame);
  const std::size_t payload = serialized(message.plane_cloud.data).size() +
                              serialized(message.descriptor).size() +
                              serialized(message.texture).size() + sizeof(message.texture_format);
  return serialized(message).size() - payload;
}

/// Deserialises and converts. Returns false when either refuses the bytes.
bool survives(const std::vector<std::uint8_t>& bytes) {
  try {
    static_cast<void>(fromMessage(deserialized(bytes)));
    return true;
  } catch (const ros::serialization::StreamOverrunException&) {
  } catch (const MessageError&) {
  } catch (const std::bad_alloc&) {  // a corrupt length; roscpp catches and reports it
  } catch (const std::length_error&) {
  }
  return false;
}

/// roscpp reserves what a corrupt length claims, up to 4 GiB: let that fail fast.
void limitMemory() {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  statm >> pages;
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = (pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE))) + (64U << 20U);
  setrlimit(RLIMIT_AS, &limit);
}

TEST(WireFormat, ReadsTheFirstVersion) {
  const std::vector<std::uint8_t> bytes = fixture("keyframe_v1.bin");
  ASSERT_FALSE(bytes.empty());
  const planecloud_slam::PlaneCloudKeyframe message = deserialized(bytes);
  EXPECT_EQ(message.plane_cloud.header.frame_id, kKnownFrame);
  const Keyframe read = fromMessage(message);
  Keyframe known = asTravelled(knownKeyframe());
  // Sines differ by an ulp between C libraries, which float32 may round to its next number.
  ASSERT_EQ(read.edges.size(), known.edges.size());
  EXPECT_TRUE(read.T_odom_camera.isApprox(known.T_odom_camera, 1e-6));
  known.T_odom_camera = read.T_odom_camera;
  for (std::size_t i = 0; i < known.edges.size(); ++i) {
    EXPECT_TRUE(read.edges[i].T_other_this.isApprox(known.edges[i].T_other_this, 1e-6));
    EXPECT_TRUE(read.edges[i].information.isApprox(known.edges[i].information, 1e-6));
    known.edges[i].T_other_this = read.edges[i].T_other_this;
    known.edges[i].information = read.edges[i].information;
  }
  expectEqual(read, known);
}

TEST(WireFormat, IsTheOneOfEveryRecordedBag) {
  using ros::message_traits::md5sum;
  EXPECT_STREQ(md5sum<planecloud_slam::PlaneCloudKeyframe>(), "48547f56a41b113a31382613599408a9");
  EXPECT_STREQ(md5sum<planecloud_slam::PlaneCloud>(), "1ed0ba669f7f939716e8058ccc570ca0");
  EXPECT_STREQ(md5sum<planecloud_slam::RelativePoseEdge>(), "ce1bb284d0dab7f3ef3cba0f3977fc7b");
  EXPECT_STREQ(md5sum<planecloud_slam::KeyframeAck>(), "0f7e2d8632ca44afc638d0106f72fac9");
  EXPECT_STREQ(ros::service_traits::md5sum<planecloud_slam::ExportMap>(),
               "628205d714ef1496481bba93184f04c3");
}

TEST(WireFormat, CostsUnder250BytesAndUnder128ForEachFurtherEdge) {
  EXPECT_LT(overhead(1), 250U);
  for (const std::size_t edges : {2U, 5U, 9U}) {
    EXPECT_LE(overhead(edges), overhead(1) + 128 * (edges - 1));
  }
}

TEST(WireFormat, IsRefusedWhereverItIsCutOff) {
  const std::vector<std::uint8_t> whole = serialized(toMessage(knownKeyframe(), kKnownFrame));
  ASSERT_TRUE(survives(whole));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto end = whole.begin() + static_cast<std::ptrdiff_t>(length);
    EXPECT_FALSE(survives({whole.begin(), end})) << length << " of " << whole.size() << " bytes";
  }
}

TEST(WireFormat, IsReadOrRefusedWhicheverBitFlips) {
  limitMemory();
  const std::vector<std::uint8_t> whole = serialized(toMessage(knownKeyframe(), kKnownFrame));
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::vector<std::uint8_t> flipped = whole;
    flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1U << (bit % 8)));
    refused += survives(flipped) ? 0 : 1;
  }
  EXPECT_GT(refused, 100U);  // lengths, counts, encodings, exponents
}

TEST(WireFormat, IsReadOrRefusedWhateverBytesAreOverwritten) {
  limitMemory();
  const std::vector<std::uint8_t> whole = serialized(toMessage(knownKeyframe(), kKnownFrame));
  std::mt19937 random(1);
  std::size_t refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::uint8_t> mutant = whole;
    for (std::size_t changes = 1 + random() % 8; changes > 0; --changes) {
      mutant[random() % mutant.size()] = static_cast<std::uint8_t>(random());
    }
    refused += survives(mutant) ? 0 : 1;
  }
  EXPECT_GT(refused, 1000U);
}

}  // namespace
}  // namespace planecloud
