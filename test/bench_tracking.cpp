// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How fast and how true tracking is.
// Usage: bench_tracking [--means | --ablation | --information | --trials] INPUT... [key=value...]
// INPUT is a folder in the TUM layout, hallway:SEED (the drive around the block) or corridor:SEED
// (once along its 15 m); a key is one of the frontend's options, e.g. tracking/levels=4.
// --trials runs twenty seeds of the trials of loss in the built-in world, and five in each INPUT.
// Without a flag: time, ATE and RPE beside cv::rgbd::RgbdOdometry on the same frames.
#include "bench_tracking.h"

#include <cstdio>
#include <exception>
#include <string>

#include "planecloud_slam/plane_fit/option_values.h"

namespace planecloud::bench {
namespace {

constexpr int kTrialSeeds = 20;

int run(int argc, char** argv) {
  std::string mode;
  std::vector<std::string> inputs;
  OptionValues values;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (argument.rfind("--", 0) == 0) {
      mode = argument;  // "--trials=5": five seeds
    } else if (equals != std::string::npos) {
      values[argument.substr(0, equals)] = argument.substr(equals + 1);
    } else {
      inputs.push_back(argument);
    }
  }
  FrontendOptions options;
  takeOptions(values, options, "");
  if (mode.rfind("--trials", 0) == 0 && values.empty()) {
    runTrials(inputs, options, mode == "--trials" ? kTrialSeeds : std::stoi(mode.substr(9)));
    return 0;
  }
  if (!values.empty() || inputs.empty()) {
    std::fprintf(stderr, values.empty() ? "no INPUT\n" : "unknown key: %s\n",
                 values.empty() ? "" : values.begin()->first.c_str());
    return 2;
  }
  FrameSets sets;
  for (const std::string& input : inputs) {
    sets.push_back(std::make_shared<const FrameSet>(loadFrameSet(input)));
  }
  if (mode.empty()) {
    comparePeer(sets, options);
  } else if (mode == "--ablation" || mode == "--means") {
    runAblation(sets, options, mode == "--means");
  } else if (mode == "--information") {
    judgeInformation(sets, options);
  } else {
    std::fprintf(stderr, "unknown flag: %s\n", mode.c_str());
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace planecloud::bench

int main(int argc, char** argv) {
  try {
    return planecloud::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
