// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "planecloud_slam/rosbags/sequence_folder.h"

namespace planecloud {

/// Writes a folder in the TUM layout as a bag under `rawTopics`: the pairs of associations.txt,
/// depth as 32FC1 in metres (nothing is lost), each image with its own stamp, `ground_truth` where
/// the folder has it. `progress` is called once per pair. Throws std::runtime_error naming the file
/// that cannot be read or written.
void writeSequenceBag(const SequenceFolder& folder, const std::string& path,
                      const std::function<void()>& progress = {});

}  // namespace planecloud
