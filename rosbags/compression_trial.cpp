// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/compression_trial.h"

#include <cmath>
#include <utility>

#include "planecloud_slam/plane_fit/depth_codec.h"
#include "planecloud_slam/plane_fit/depth_traits.h"
#include "planecloud_slam/plane_fit/reconstruction.h"
#include "planecloud_slam/rosbags/stopwatch.h"

namespace planecloud {
namespace {

/// Sum and number of what is added.
struct Mean {
  double sum = 0.0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double value() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

void measureFit(const Image<float>& depth, const Camera& camera, CompressedFrame& result) {
  Mean distance, difference;
  for (const PlanarTile& tile : result.cloud.tiles) {
    const Eigen::Vector4d plane = tile.plane();
    for (int y = tile.rect.y; y < tile.rect.y + tile.rect.height; ++y) {
      for (int x = tile.rect.x; x < tile.rect.x + tile.rect.width; ++x) {
        const float z = depth(x, y);
        if (!hasDepth(z)) continue;
        const Eigen::Vector3d point = camera.backProject(x, y, static_cast<double>(z));
        distance.add(std::abs(plane.head<3>().dot(point) + plane.w()));
        difference.add(std::abs(static_cast<double>(result.depth(x, y) - z)));
      }
    }
  }
  result.point_plane_error = distance.value();
  result.depth_error = difference.value();
}

/// Share of the pixels with depth where planes have one, too.
double coverageOf(const Image<float>& depth, const Image<float>& restored) {
  Mean covered;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (hasDepth(depth(x, y))) covered.add(hasDepth(restored(x, y)) ? 1.0 : 0.0);
    }
  }
  return covered.value();
}

TrueErrors measureTruth(const Image<float>& depth, const Image<float>& true_depth,
                        const Camera& camera, const Image<float>& restored) {
  Mean compressed, raw;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const float truth = true_depth(x, y);
      if (!hasDepth(truth) || !hasDepth(depth(x, y)) || !hasDepth(restored(x, y))) continue;
      const double ray = camera.backProject(x, y, 1.0).norm();
      compressed.add(ray * std::abs(static_cast<double>(restored(x, y) - truth)));
      raw.add(ray * std::abs(static_cast<double>(depth(x, y) - truth)));
    }
  }
  return {compressed.value(), raw.value()};
}

}  // namespace

CompressionTrial::CompressionTrial(const CameraIntrinsics& camera,
                                   const CompressionOptions& options)
    : camera_(std::make_shared<const Camera>(camera)),
      options_(options),
      fitter_(camera_, options.plane_fit) {
  options_.codec.check();
  options_.texture.check();
}

CompressedFrame CompressionTrial::compress(const CompressionItem& item) {
  const RgbdFrame& frame = item.frame;
  CompressedFrame result;
  result.stamp = frame.stamp;
  FitBudget budget = FitBudget::fromNow(options_.plane_fit.time_budget, &FitBudget::Clock::now);
  if (options_.plane_fit.byte_budget > 0) {
    budget.bytes = static_cast<std::size_t>(options_.plane_fit.byte_budget);
  }
  const Stopwatch fit;
  PlaneCloud cloud = fitter_.fit(frame.depth.view(), budget);
  result.fit_time = fit.elapsed();
  const Stopwatch coding;
  KeyframePayload payload =
      encodePayload({std::move(cloud), frame.depth.view(), fitter_.options()},
                    {frame.grey.view(), frame.color.view()}, {options_.codec, options_.texture});
  result.encode_time = coding.elapsed();
  result.lossless_bytes =
      encodeDepth(frame.depth.view(), camera_->intrinsics(), fitter_.options()).bytes.size();
  const Stopwatch decoding;
  result.cloud = decode(payload.planes);
  result.decode_time = decoding.elapsed();
  result.bytes = payload.bytes();
  result.texture_bytes = payload.texture.bytes.size();
  result.texture = std::move(payload.texture);
  result.planes = result.cloud.tiles.size();
  result.depth = reconstructDepth(result.cloud, *camera_);
  measureFit(frame.depth, *camera_, result);
  const Image<float>& sensed = item.raw_depth ? *item.raw_depth : frame.depth;
  result.coverage = coverageOf(sensed, result.depth);
  if (item.true_depth) {
    result.truth = measureTruth(sensed, *item.true_depth, *camera_, result.depth);
  }
  return result;
}

}  // namespace planecloud
