// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "plane_fit_peers.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/plane_fit/reconstruction.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"
#include "quantile.h"
#include "recorded_depth.h"

/// Fit, encode and decode on recorded depth: milliseconds, planes, errors and bytes; then the times
/// of other plane extractors on the same frames.
///
///     bench_plane_fit [FRAMES [REPETITIONS]]
namespace planecloud {
namespace {

using Clock = std::chrono::steady_clock;

struct Setting {
  const char* name;
  QuadtreeFitterOptions fitter;
  CodecOptions codec;
  bool is_peer = false;  ///< what other extractors are compared with
};

QuadtreeFitterOptions fixed(double tolerance, bool along_ray) {
  QuadtreeFitterOptions options;
  options.acceptance = AcceptanceRule::kFixed;
  options.tolerance = tolerance;
  options.along_ray_test = along_ray;
  return options;
}

std::vector<Setting> settings() {
  return {{"fixed 13.1 mm", fixed(0.0131, true), {}, true},
          {"fixed 13.1 mm, no ray test", fixed(0.0131, false), {}},
          {"fixed 2.7 mm", fixed(0.0027, true), {}, true},
          {"fixed 2.7 mm, no ray test", fixed(0.0027, false), {}},
          {"default", {}, {}}};
}

double milliseconds(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Totals {
  std::vector<double> fit, encode, decode;  // [ms]
  double planes = 0, bytes = 0, coverage = 0, point_plane = 0, depth = 0, decoded_depth = 0;
};

double meanDepthError(const PlaneCloud& cloud, const Camera& camera, const Image<float>& depth) {
  const Image<float> drawn = reconstructDepth(cloud, camera);
  double sum = 0.0;
  double count = 0.0;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (!(depth(x, y) > 0.0F) || std::isnan(drawn(x, y))) continue;
      sum += std::abs(drawn(x, y) - depth(x, y));
      count += 1.0;
    }
  }
  return sum / std::max(1.0, count);
}

Totals measure(const Setting& setting, const RecordedDepth& recorded, int repetitions) {
  const auto camera = std::make_shared<const Camera>(recorded.camera);
  QuadtreeFitter fitter(camera, setting.fitter);
  Totals totals;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (const Image<float>& depth : recorded.depth) {
      const Clock::time_point fit_start = Clock::now();
      const PlaneCloud cloud = fitter.fit(depth.view());
      totals.fit.push_back(milliseconds(fit_start));
      const Clock::time_point encode_start = Clock::now();
      const EncodedPlaneCloud encoded = encode(cloud, setting.codec);
      totals.encode.push_back(milliseconds(encode_start));
      const Clock::time_point decode_start = Clock::now();
      const PlaneCloud decoded = decode(encoded);
      totals.decode.push_back(milliseconds(decode_start));
      if (repetition > 0) continue;
      totals.planes += static_cast<double>(cloud.tiles.size());
      totals.bytes += static_cast<double>(encoded.bytes.size());
      totals.coverage += cloud.statistics.coverage;
      totals.point_plane += cloud.statistics.point_plane_error;
      totals.depth += cloud.statistics.depth_error;
      totals.decoded_depth += meanDepthError(decoded, *camera, depth);
    }
  }
  return totals;
}

void print(const Setting& setting, const Totals& totals, double frames) {
  std::printf("%-28s %5.2f %5.2f %5.2f %5.2f %6.0f %6.0f %5.2f %6.2f %7.2f %6.2f %+6.2f\n",
              setting.name, quantile(totals.fit, 0.5), quantile(totals.fit, 0.95),
              quantile(totals.encode, 0.5), quantile(totals.decode, 0.5), totals.planes / frames,
              totals.bytes / frames, 8.0 * totals.bytes / totals.planes,
              100.0 * totals.coverage / frames, 1e3 * totals.point_plane / frames,
              1e3 * totals.depth / frames, 100.0 * (totals.decoded_depth / totals.depth - 1.0));
}

/// Median milliseconds of a peer, beside our medians at 13.1 and 2.7 mm.
template <typename Extract>
void printPeer(const char* name, const RecordedDepth& recorded, const std::vector<double>& ours,
               Extract&& extract) {
  std::vector<double> times;
  double planes = 0.0;
  for (const Image<float>& depth : recorded.depth) {
    const ExtractedPlanes extracted = extract(depth);
    times.push_back(extracted.milliseconds);
    planes += static_cast<double>(extracted.planes);
  }
  const double median = quantile(times, 0.5);
  if (median == 0.0) {
    std::printf("%-36s skipped: the library is not there\n", name);
    return;
  }
  std::printf("%-36s %7.2f ms %7.0f planes   %.1f / %.1f times ours\n", name, median,
              planes / static_cast<double>(recorded.depth.size()), median / ours[0],
              median / ours[1]);
}

void printPeers(const RecordedDepth& recorded, const std::vector<double>& ours) {
  const Camera camera(recorded.camera);
  printPeer("OpenCV RgbdPlane, block 20", recorded, ours,
            [&](const Image<float>& depth) { return extractByRgbdPlane(depth, camera); });
  printPeer("PCL organized multi-plane, normals", recorded, ours,
            [&](const Image<float>& depth) { return extractByPcl(depth, camera); });
  for (const double tolerance : {0.0131, 0.0027}) {
    printPeer(tolerance > 0.01 ? "the paper, 24 to 3 px, 13.1 mm" : "the paper, 24 to 3 px, 2.7 mm",
              recorded, ours, [&](const Image<float>& depth) {
                return extractAsInThePaper(depth, camera, tolerance);
              });
  }
}

int run(std::size_t frames, int repetitions) {
  std::printf("kernels: %s\n", vectorTileKernels().name);
  for (const char* sequence : {"tum_fr1_xyz_first_300", "tum_fr3_cabinet_58"}) {
    const RecordedDepth recorded = loadRecordedDepth(sequence, frames);
    if (recorded.depth.empty()) {
      std::fprintf(stderr, "no depth images of %s: set PLANECLOUD_SLAM_DATA\n", sequence);
      return 1;
    }
    std::printf("\n%-28s %5s %5s %5s %5s %6s %6s %5s %6s %7s %6s %6s\n", sequence, "fit", "p95",
                "enc", "dec", "planes", "bytes", "bits", "cov %", "p-pl mm", "dep mm", "dec %");
    std::vector<double> ours;
    for (const Setting& setting : settings()) {
      const Totals totals = measure(setting, recorded, repetitions);
      print(setting, totals, static_cast<double>(recorded.depth.size()));
      if (setting.is_peer) ours.push_back(quantile(totals.fit, 0.5));
    }
    printPeers(recorded, ours);
  }
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 20;
  const int repetitions = argc > 2 ? std::atoi(argv[2]) : 5;
  if (frames < 1 || repetitions < 1) {
    std::fprintf(stderr, "usage: bench_plane_fit [FRAMES [REPETITIONS]]\n");
    return 2;
  }
  return planecloud::run(static_cast<std::size_t>(frames), repetitions);
}
