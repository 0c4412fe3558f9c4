// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <map>

#include "bench_tracking.h"
#include "planecloud_slam/rosbags/hallway_recording.h"
#include "planecloud_slam/rosbags/replay_run.h"
#include "planecloud_slam/rosbags/replay_trajectories.h"
#include "tracking_trials.h"

namespace planecloud::bench {
namespace {

constexpr double kRegained = 1.0;   // [s]
constexpr double kWorseMap = 0.02;  // [m]
constexpr double kTrialSeconds = 11.0;
constexpr double kFirstSecond = 4.0;

/// Sums over the seeds of one kind of trial.
struct Tally {
  int trials = 0, wrong_frames = 0, blind_good = 0, seen = 0, regained = 0, other_segment = 0,
      worse = 0;
  double worst = 0.0, slowest = 0.0, worst_map = -1.0;
};

FrameSet part(const FrameSet& set, std::size_t begin, std::size_t end) {
  FrameSet cut = set;
  const auto from = static_cast<std::ptrdiff_t>(begin);
  const auto to = static_cast<std::ptrdiff_t>(std::min(end, set.frames.size()));
  cut.frames.assign(set.frames.begin() + from, set.frames.begin() + to);
  if (!set.wheels.empty()) {
    cut.wheels.assign(set.wheels.begin() + from, set.wheels.begin() + to);
  }
  return cut;
}

/// What a run with backend or, with wheels, without made of a trial.
struct TrialRun {
  std::vector<FrameResult> frames;
  KeyframeStamps stamps;
  double ate = 0.0;
};

TrialRun runTrial(const FrameSet& set, const FrontendOptions& options, bool wheels) {
  TrialRun run;
  if (wheels) {
    TrackingRun tracked = track(set, options, true);
    run.ate = odometryErrors(set, tracked).ate_rmse;
    for (const Keyframe& keyframe : tracked.keyframes) run.stamps[keyframe.id] = keyframe.stamp;
    run.frames = std::move(tracked.frames);
    return run;
  }
  ReplayOptions replay;
  replay.robots.frontend = options;
  const auto shared = std::make_shared<const FrameSet>(set);
  ReplayResult result = runReplay({std::make_shared<MemoryRecording>(shared)}, replay);
  const Trajectory frames = extractTrajectories(result.robots.front(), *result.map).frames;
  run.ate = evaluateTrajectories({{set.truth, frames}}).ate_rmse;
  for (const MapSnapshot::Node& node : result.map->nodes) {
    run.stamps[node.keyframe->id] = node.keyframe->stamp;
  }
  run.frames = std::move(result.robots.front().frames);
  return run;
}

void enter(const Trial& trial, double undisturbed, const TrialRun& run, Tally& tally) {
  const TrialOutcome outcome = judgeTrial(trial, run.frames, run.stamps);
  ++tally.trials;
  tally.wrong_frames += static_cast<int>(outcome.wrong);
  tally.blind_good += static_cast<int>(outcome.blind_good);
  tally.worst = std::max(tally.worst, outcome.worst);
  tally.other_segment += outcome.same_segment ? 0 : 1;
  if (outcome.seen_before) {
    ++tally.seen;
    tally.regained += outcome.regained_after <= kRegained ? 1 : 0;
    if (outcome.regained_after < 1e6) {
      tally.slowest = std::max(tally.slowest, outcome.regained_after);
    }
  }
  tally.worst_map = std::max(tally.worst_map, run.ate - undisturbed);
  tally.worse += run.ate - undisturbed > kWorseMap ? 1 : 0;
}

using Tallies = std::vector<std::pair<std::string, Tally>>;

Tally& tallyOf(Tallies& tallies, const std::string& name) {
  for (auto& [known, tally] : tallies) {
    if (known == name) return tally;
  }
  tallies.emplace_back(name, Tally());
  return tallies.back().second;
}

void enterAll(const FrameSet& set, std::uint64_t seed, const FrontendOptions& options,
              Tallies& tallies) {
  const double undisturbed = systemErrors(std::make_shared<const FrameSet>(set), options).ate_rmse;
  for (const Trial& trial : makeTrials(set, seed)) {
    enter(trial, undisturbed, runTrial(trial.set, options, false), tallyOf(tallies, trial.name));
    if (trial.set.wheels.empty() || trial.name.find("blank wall") == std::string::npos) continue;
    enter(trial, undisturbed, runTrial(trial.set, options, true),
          tallyOf(tallies, trial.name + ", wheels"));
  }
}

void print(const Tallies& tallies) {
  std::printf("%-24s %6s %6s %8s %6s %9s %8s %9s %6s %9s\n", "trial", "seeds", "wrong", "worst cm",
              "blind", "regained", "slowest", "segments", "worse", "map cm");
  for (const auto& [name, tally] : tallies) {
    std::printf("%-24s %6d %6d %8.1f %6d %4d/%4d %7.2fs %9d %6d %9.1f\n", name.c_str(),
                tally.trials, tally.wrong_frames, 100.0 * tally.worst, tally.blind_good,
                tally.regained, tally.seen, tally.slowest, tally.other_segment, tally.worse,
                100.0 * tally.worst_map);
  }
}

}  // namespace

void runTrials(const std::vector<std::string>& inputs, const FrontendOptions& options, int seeds) {
  std::printf(
      "wrong: good frames off by more than 10 cm; blind: good frames without a view; regained: of\n"
      "those seen before, within 1 s; segments: trials that opened one; worse: maps by more than 2 "
      "cm\n");
  Tallies tallies;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto frames =
        static_cast<std::size_t>(kTrialSeconds * HallwayRecording::kFramesPerSecond);
    const auto first = static_cast<std::size_t>(kFirstSecond * HallwayRecording::kFramesPerSecond);
    const FrameSet set = loadFrameSet("hallway:" + std::to_string(seed), first + frames);
    enterAll(part(set, first, first + frames), static_cast<std::uint64_t>(seed), options, tallies);
    const Trial turn = makeFastTurn(static_cast<std::uint64_t>(seed), set.camera);
    enter(turn, 0.0, runTrial(turn.set, options, false), tallyOf(tallies, turn.name));
    std::fprintf(stderr, "seed %d\n", seed);
  }
  if (seeds > 0) print(tallies);
  for (const std::string& input : inputs) {
    Tallies real;
    const FrameSet set = loadFrameSet(input);
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(std::max(1, seeds / 4));
         ++seed) {
      enterAll(set, seed, options, real);
    }
    std::printf("%s\n", set.name.c_str());
    print(real);
  }
}

}  // namespace planecloud::bench
