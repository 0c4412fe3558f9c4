// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "frame_set.h"
#include "planecloud_slam/frontend_node/keyframe_payload.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "quantile.h"

/// Are budgets kept, and is a larger one always worth it? Bytes of planes and texture against byte
/// budgets, wall time of fits against time budgets (run something else beside it).
///
///     bench_keyframe_budgets INPUT [FRAMES [REPETITIONS]]
///
/// Ends with 1 when a budget was exceeded or a larger one covered less.
namespace planecloud {
namespace {

/// Coverage of one frame may fall by this from one time budget to the next: the fit is cut off at
/// another tile every time.
constexpr double kTimeJitter = 0.02;

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// One budget's outcome.
struct Row {
  double budget = 0.0, largest = 0.0, typical = 0.0;
  std::vector<double> coverage;
};

/// Prints a row and returns whether it obeys `limit` and covers no less than the row before.
bool judge(const Row& row, double limit, const Row* before, double jitter) {
  bool covers = true;
  for (std::size_t i = 0; before != nullptr && i < row.coverage.size(); ++i) {
    covers = covers && row.coverage[i] >= before->coverage[i] - jitter;
  }
  const bool obeys = row.largest <= limit;
  std::printf("%10.1f %10.2f %10.2f %9.2f %%%s%s\n", row.budget, row.typical, row.largest,
              100.0 * mean(row.coverage), obeys ? "" : "  EXCEEDED", covers ? "" : "  COVERS LESS");
  return obeys && covers;
}

bool sweepBytes(const FrameSet& set) {
  std::printf("\nbytes of planes and texture\n%10s %10s %10s %11s\n", "budget", "median", "most",
              "coverage");
  const auto camera = std::make_shared<const Camera>(set.camera);
  PayloadOptions options;
  QuadtreeFitterOptions plane_fit;
  plane_fit.tolerance = 0.001;  // enough planes to fill the largest budgets
  plane_fit.lambda = 1.0;
  QuadtreeFitter fitter(camera, plane_fit);
  std::vector<PlaneCloud> clouds;
  for (const auto& frame : set.frames) clouds.push_back(fitter.fit(frame->depth.view()));
  bool good = true;
  std::vector<Row> rows;
  for (double budget = 300.0; budget < 52000.0; budget *= 1.3) {
    options.codec.byte_budget = static_cast<int>(budget);
    std::vector<double> bytes;
    Row row;
    row.budget = options.codec.byte_budget;
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      const RgbdFrame& frame = *set.frames[i];
      const KeyframePayload payload = encodePayload({clouds[i], frame.depth.view(), plane_fit},
                                                    {frame.grey.view(), {}}, options);
      bytes.push_back(static_cast<double>(payload.bytes()));
      row.coverage.push_back(payload.planes.statistics.coverage);
    }
    row.typical = quantile(bytes, 0.5);
    row.largest = quantile(bytes, 1.0);
    good = judge(row, row.budget, rows.empty() ? nullptr : &rows.back(), 0.0) && good;
    rows.push_back(std::move(row));
  }
  return good;
}

bool sweepTime(const FrameSet& set, int repetitions) {
  std::printf("\nmilliseconds of a fit (largest: 99 of 100)\n%10s %10s %10s %11s\n", "budget",
              "median", "p99", "coverage");
  const auto camera = std::make_shared<const Camera>(set.camera);
  QuadtreeFitterOptions options;
  options.min_tile = 2;
  options.tolerance = 0.001;
  QuadtreeFitter fitter(camera, options);
  bool good = true;
  std::vector<Row> rows;
  for (double budget = 0.3; budget < 85.0; budget *= 1.4) {
    std::vector<double> times;
    Row row;
    row.budget = budget;
    for (const auto& frame : set.frames) {
      double best = 0.0;
      for (int repetition = 0; repetition < repetitions; ++repetition) {
        const auto start = FitBudget::Clock::now();
        const PlaneCloud cloud = fitter.fit(
            frame->depth.view(), FitBudget::fromNow(1e-3 * budget, &FitBudget::Clock::now));
        times.push_back(
            std::chrono::duration<double, std::milli>(FitBudget::Clock::now() - start).count());
        best = std::max(best, cloud.statistics.coverage);
      }
      row.coverage.push_back(best);
    }
    row.typical = quantile(times, 0.5);
    row.largest = quantile(times, 0.99);
    const double limit = 1.1 * budget + 0.1;
    good = judge(row, limit, rows.empty() ? nullptr : &rows.back(), kTimeJitter) && good;
    rows.push_back(std::move(row));
  }
  return good;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  const int frames = argc > 2 ? std::atoi(argv[2]) : 20;
  const int repetitions = argc > 3 ? std::atoi(argv[3]) : 10;
  if (argc < 2 || frames < 1 || repetitions < 1) {
    std::fprintf(stderr, "usage: bench_keyframe_budgets INPUT [FRAMES [REPETITIONS]]\n");
    return 2;
  }
  const planecloud::FrameSet set =
      planecloud::loadFrameSet(argv[1], static_cast<std::size_t>(frames));
  const bool bytes = planecloud::sweepBytes(set);
  const bool time = planecloud::sweepTime(set, repetitions);
  return bytes && time ? 0 : 1;
}
