// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <boost/program_options.hpp>
#include <string>

#include "planecloud_slam/rosbags/command_line.h"
#include "planecloud_slam/rosbags/open_recordings.h"
#include "planecloud_slam/rosbags/progress_bar.h"
#include "planecloud_slam/rosbags/sequence_bag.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

ToolDescription description() {
  ToolDescription tool;
  tool.name = "sequence_to_bag";
  tool.summary =
      "Converts a folder in the layout of the TUM RGB-D benchmark into a bag: the image pairs of\n"
      "associations.txt, camera info, and ground truth where the folder has it.";
  tool.synopsis = "DIR F.bag [flags]";
  tool.notes =
      "The images are not rectified, so the topics are those of the benchmark's own bags:\n"
      "/camera/rgb/image_color, /camera/depth/image (32FC1), /camera/rgb/camera_info,\n"
      "/ground_truth.";
  addSequenceFlags(tool.flags);
  tool.arguments = {"DIR", "F.bag"};
  return tool;
}

int run(const ParsedFlags& flags) {
  const auto bags = flags["F.bag"].as<std::vector<std::string>>();
  if (bags.size() != 1) throw UsageError("expected one file to write: DIR F.bag");
  const SequenceFolder folder =
      openSequenceFolder(flags["DIR"].as<std::string>(), readSequenceFlags(flags));
  ProgressBar progress("writing", folder.pairs.size());
  writeSequenceBag(folder, bags.front(), [&] { progress.advance(); });
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  return planecloud::runTool(planecloud::description(), argc, argv, planecloud::run);
}
