// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What false closures do to the map: 10, 30 and 50 % of all closures replaced by false ones, half
// of them at random, half in mutually consistent groups of five; ten seeds.
// Usage: bench_backend_closures [key=value...], e.g. graph/kernel=none
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "false_closures.h"
#include "planecloud_slam/plane_fit/option_values.h"

namespace planecloud {
namespace {

constexpr unsigned kSeeds = 10;

int run(int argc, char** argv) {
  BackendOptions options;
  OptionValues values;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) return 2;
    values[argument.substr(0, equals)] = argument.substr(equals + 1);
  }
  takeOptions(values, options, "");
  if (!values.empty()) return 2;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::vector<double> none;
  std::printf("%6s %12s %12s %12s %12s %12s\n", "false", "mean ATE", "worst ratio", "mean ratio",
              "kept false", "kept true");
  for (const double share : {0.0, 0.1, 0.3, 0.5}) {
    double sum = 0.0, ratio = 0.0, worst = 0.0;
    int kept_false = 0, offered_false = 0, kept_true = 0, offered_true = 0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const FalseClosureResult result = runFalseClosures({share, seed}, options);
      if (share == 0.0) none.push_back(result.ate);
      sum += result.ate / kSeeds;
      ratio += result.ate / none[seed - 1] / kSeeds;
      worst = std::max(worst, result.ate / none[seed - 1]);
      kept_false += result.kept_false;
      offered_false += result.offered_false;
      kept_true += result.kept_true;
      offered_true += result.offered_true;
    }
    std::printf("%5.0f%% %9.4f m  %11.2f  %11.2f  %6d/%-6d %6d/%-6d\n", 100.0 * share, sum, worst,
                ratio, kept_false, offered_false, kept_true, offered_true);
  }
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) { return planecloud::run(argc, argv); }
