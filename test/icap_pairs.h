// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "planecloud_slam/rosbags/sequence_folder.h"

/// The pairs of frames ICaP is judged on, named by the stamps of their depth images.
namespace planecloud {

struct StampPair {
  double target = 0.0;  ///< [s]
  double source = 0.0;  ///< [s]
};

/// Pairs 5-40 cm and under 30 degrees apart by ground truth, the earlier frame the target: all of
/// them in the order of the recording, or `count` drawn by a fixed seed when there are more.
[[nodiscard]] std::vector<StampPair> choosePairs(const SequenceFolder& folder, std::size_t count);

/// A line each, `target source`; lines that begin with # are skipped.
[[nodiscard]] std::vector<StampPair> readPairs(const std::string& path);

/// Prints what `readPairs` reads.
void printPairs(const std::vector<StampPair>& pairs);

}  // namespace planecloud
