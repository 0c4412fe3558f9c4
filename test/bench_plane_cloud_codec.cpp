// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "depth_codec_peers.h"
#include "planecloud_slam/plane_fit/fitted_depth.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/plane_fit/reconstruction.h"
#include "recorded_depth.h"

/// Bytes of plane clouds and of other depth codecs at equal error, on recorded depth.
///
///     bench_plane_cloud_codec [FRAMES]
namespace planecloud {
namespace {

/// Means over the frames.
struct Row {
  double bytes = 0, planes = 0, coverage = 0, depth_error = 0, fitted_error = 0;
};

QuadtreeFitterOptions fixed(double tolerance, double lambda) {
  QuadtreeFitterOptions options;
  options.acceptance = AcceptanceRule::kFixed;
  options.tolerance = tolerance;
  options.lambda = lambda;
  return options;
}

/// Mean depth error of what is covered, and the covered share of the pixels with depth.
std::pair<double, double> compare(const PlaneCloud& cloud, const Camera& camera,
                                  const Image<float>& depth) {
  const Image<float> drawn = reconstructDepth(cloud, camera);
  double sum = 0, covered = 0, valid = 0;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (!(depth(x, y) > 0.0F)) continue;
      valid += 1.0;
      if (std::isnan(drawn(x, y))) continue;
      covered += 1.0;
      sum += std::abs(static_cast<double>(drawn(x, y) - depth(x, y)));
    }
  }
  return {sum / std::max(1.0, covered), covered / std::max(1.0, valid)};
}

Row measure(const RecordedDepth& recorded, const QuadtreeFitterOptions& plane_fit,
            const CodecOptions& codec) {
  const auto camera = std::make_shared<const Camera>(recorded.camera);
  QuadtreeFitter fitter(camera, plane_fit);
  Row row;
  const auto frames = static_cast<double>(recorded.depth.size());
  for (const Image<float>& depth : recorded.depth) {
    const PlaneCloud cloud = fitter.fit(depth.view());
    const EncodedPlaneCloud encoded = encode({cloud, depth.view(), plane_fit}, codec);
    const auto [error, coverage] = compare(decode(encoded), *camera, depth);
    row.bytes += static_cast<double>(encoded.bytes.size()) / frames;
    row.planes += encoded.plane_count / frames;
    row.coverage += coverage / frames;
    row.depth_error += error / frames;
    row.fitted_error += compare(cloud, *camera, depth).first / frames;
  }
  return row;
}

void print(const char* name, const Row& row) {
  std::printf("%-46s %8.0f B %6.0f planes %6.2f %% %7.2f mm\n", name, row.bytes, row.planes,
              100.0 * row.coverage, 1e3 * row.depth_error);
}

void againstRaw(const RecordedDepth& recorded, double tolerance) {
  CodecOptions codec;
  codec.quantisation_step = 1e-3;
  const Row row = measure(recorded, fixed(tolerance, 0.0), codec);
  const std::string name =
      "same planes, fixed " + std::to_string(1e3 * tolerance).substr(0, 4) + " mm";
  print(name.c_str(), row);
  std::printf("    %.1f times smaller than 32 B each; quantisation adds %.1f %% to the error\n",
              32.0 * row.planes / row.bytes, 100.0 * (row.depth_error / row.fitted_error - 1.0));
}

/// The dearest bit at which the mean error is `wanted` [m]: the error rises with the price.
Row atError(const RecordedDepth& recorded, QuadtreeFitterOptions options, const CodecOptions& codec,
            double wanted) {
  double low = 0.1;
  double high = 50.0;
  Row best;
  for (int i = 0; i < 6; ++i) {
    options.lambda = std::sqrt(low * high);
    const Row row = measure(recorded, options, codec);
    if (row.depth_error <= wanted) {
      low = options.lambda;
      best = row;
    } else {
      high = options.lambda;
    }
  }
  return best;
}

/// The fewest bytes at mean depth error `wanted` [m] over at least `coverage` of the pixels, mask
/// included. Tiles may span what has no depth: the mask says so.
Row cheapestAtError(const RecordedDepth& recorded, double wanted, double coverage) {
  QuadtreeFitterOptions options;
  options.corner_check = CornerCheck::kNone;
  options.min_fill = 0.1;
  CodecOptions codec;
  codec.mask = true;
  Row best;
  for (const double tolerance : {0.003, 0.006, 0.009, 0.012}) {
    for (const double step : {2e-3, 4e-3, 8e-3}) {
      options.tolerance = tolerance;
      codec.quantisation_step = step;
      const Row row = atError(recorded, options, codec, wanted);
      if (row.bytes == 0.0 || row.coverage < coverage) continue;
      if (best.bytes == 0.0 || row.bytes < best.bytes) best = row;
    }
  }
  return best;
}

template <typename Encode>
void peer(const char* name, const RecordedDepth& recorded, double ours, Encode&& encode_one) {
  CodedDepth sum;
  for (const Image<float>& depth : recorded.depth) {
    const CodedDepth coded = encode_one(depth);
    if (coded.bytes == 0) {
      std::printf("%-46s skipped: the library is not there\n", name);
      return;
    }
    sum.bytes += coded.bytes;
    sum.depth_error += coded.depth_error;
  }
  const auto frames = static_cast<double>(recorded.depth.size());
  const double bytes = static_cast<double>(sum.bytes) / frames;
  std::printf("%-46s %8.0f B %20s %5.2f mm   %.1f times ours\n", name, bytes, "",
              1e3 * sum.depth_error / frames, bytes / ours);
}

void benchSequence(const char* sequence, const RecordedDepth& recorded) {
  std::printf("\n%s, %zu frames\n", sequence, recorded.depth.size());
  againstRaw(recorded, 0.0131);
  againstRaw(recorded, 0.0027);
  QuadtreeFitterOptions point_plane = fixed(0.0027, QuadtreeFitterOptions().lambda);
  point_plane.along_ray_test = false;
  print("fixed 2.7 mm point to plane, no ray test", measure(recorded, point_plane, {}));
  print("default", measure(recorded, {}, {}));

  constexpr double kError = 0.005;
  const Row ours = cheapestAtError(recorded, kError, 0.98);
  if (ours.bytes == 0.0) {
    std::printf("5 mm mean depth error was not reached: no peers\n");
    return;
  }
  print("at 5 mm mean depth error, mask included", ours);
  const Camera camera(recorded.camera);
  peer("JPEG 2000, 16-bit inverse depth", recorded, ours.bytes,
       [&](const Image<float>& depth) { return encodeJpeg2000(depth, kError); });
  peer("Draco, k-d tree", recorded, ours.bytes,
       [&](const Image<float>& depth) { return encodeDraco(depth, camera, kError); });
  peer("PNG, 16 bits, lossless", recorded, ours.bytes,
       [](const Image<float>& depth) { return encodePng(depth); });
  CodecOptions lossless;
  lossless.encoding = PlaneCloudEncoding::kLossless;
  const Row exact = measure(recorded, {}, lossless);
  std::printf("%-46s %8.0f B\n", "LOSSLESS", exact.bytes);
}

int run(std::size_t frames) {
  for (const char* sequence : {"tum_fr1_xyz_first_300", "tum_fr3_cabinet_58"}) {
    const RecordedDepth recorded = loadRecordedDepth(sequence, frames);
    if (recorded.depth.empty()) {
      std::fprintf(stderr, "no depth images of %s: set PLANECLOUD_SLAM_DATA\n", sequence);
      return 1;
    }
    benchSequence(sequence, recorded);
  }
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 20;
  if (frames < 1) {
    std::fprintf(stderr, "usage: bench_plane_cloud_codec [FRAMES]\n");
    return 2;
  }
  return planecloud::run(static_cast<std::size_t>(frames));
}
