// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <planecloud_slam/PlaneCloudKeyframe.h>
#include <ros/serialization.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <vector>

#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/planecloud_msgs/conversions.h"

/// A libFuzzer target for the way of a keyframe from the network into the backend: bytes, message,
/// core types, planes.
namespace {

/// roscpp allocates what a length field says before it looks whether that many bytes are there:
/// not ours to mend, so a larger wish fails at once.
constexpr std::size_t kMostAllocated = std::size_t{1} << 26;
constexpr int kLongestSide = 256;  // [px], larger images only cost time

}  // namespace

void* operator new(std::size_t size) {
  void* memory = size <= kMostAllocated ? std::malloc(size) : nullptr;
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

/// Ours replace only the operators for single objects, which arrays use as well.
extern "C" const char* __asan_default_options() { return "alloc_dealloc_mismatch=0"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::vector<std::uint8_t> buffer;
  buffer.reserve(size + 1);  // roscpp reckons with the address even of an empty message
  buffer.assign(bytes, bytes + size);
  planecloud_slam::PlaneCloudKeyframe message;
  try {
    ros::serialization::IStream stream(buffer.data(), static_cast<std::uint32_t>(buffer.size()));
    ros::serialization::deserialize(stream, message);
  } catch (const std::exception&) {
    return 0;
  }
  if (message.plane_cloud.width > kLongestSide || message.plane_cloud.height > kLongestSide)
    return 0;
  try {
    const planecloud::Keyframe keyframe = planecloud::fromMessage(message);
    (void)planecloud::decode(keyframe.planes);
  } catch (const planecloud::MessageError&) {
  } catch (const planecloud::PlaneCloudDecodeError&) {
  }
  return 0;
}
