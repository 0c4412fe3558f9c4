// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "planecloud_slam/rosbags/recording.h"
#include "planecloud_slam/rosbags/sequence_folder.h"

namespace planecloud {

/// What an INPUT may be, for --help.
extern const char* const kInputHelp;

/// What to say when no recording had a frame.
extern const char* const kNoPairs;

/// Adds --camera and --depth-scale.
void addSequenceFlags(boost::program_options::options_description& flags);

/// What was given of them. Throws UsageError.
[[nodiscard]] SequenceOptions readSequenceFlags(const boost::program_options::variables_map& flags);

/// Opens each INPUT: a `.bag` (only in a build with ROS), a folder in the TUM layout, or
/// `hallway:SEED[:ROBOTS]`, the built-in world rendered on the fly. One recording per robot; robots
/// of equal names are renamed. `warn` hears of damage that leaves something to read. Throws
/// UsageError for text that is none of these, and what the recordings throw.
[[nodiscard]] std::vector<std::shared_ptr<Recording>> openRecordings(
    const std::vector<std::string>& inputs, const SequenceOptions& options,
    const std::function<void(const std::string&)>& warn);

}  // namespace planecloud
