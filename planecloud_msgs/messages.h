// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The generated types live in namespace planecloud_slam as the core does, and two of them have the
// name of a core type. Whoever needs both includes this header instead of the generated ones.
#define PlaneCloud PlaneCloudMessage
#define RelativePoseEdge RelativePoseEdgeMessage
#include <planecloud_slam/KeyframeAck.h>
#include <planecloud_slam/PlaneCloudKeyframe.h>
#undef RelativePoseEdge
#undef PlaneCloud

namespace planecloud_slam {

using KeyframeMessage = PlaneCloudKeyframe;
using KeyframeAckMessage = KeyframeAck;

}  // namespace planecloud_slam
