// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "planecloud_slam/plane_fit/depth_codec.h"
#include "planecloud_slam/plane_fit/depth_traits.h"
#include "planecloud_slam/plane_fit/fitted_depth.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "recorded_depth.h"

/// Fitting and coding on recorded depth images, where they are installed.
namespace planecloud {
namespace {

class RecordedPlaneClouds : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    recorded_ = loadRecordedDepth(GetParam(), 10);
    if (recorded_.depth.empty()) {
      GTEST_SKIP() << "no recorded depth in " << recordedDataFolder() / GetParam()
                   << ": set PLANECLOUD_SLAM_DATA";
    }
    camera_ = std::make_shared<const Camera>(recorded_.camera);
  }
  RecordedDepth recorded_;
  std::shared_ptr<const Camera> camera_;
};

TEST_P(RecordedPlaneClouds, CoverWhatIsPlanarWithinTheSensorsNoise) {
  QuadtreeFitter fitter(camera_, {});
  for (const Image<float>& depth : recorded_.depth) {
    const PlaneCloudStatistics statistics = fitter.fit(depth.view()).statistics;
    EXPECT_GT(statistics.coverage, 0.85);
    // Kinect noise at 1-4 m; a step of its disparity is 2.8 mm at 1 m, 25 mm at 3 m.
    EXPECT_LT(statistics.point_plane_error, 0.006);
    EXPECT_LT(statistics.depth_error, 0.012);
  }
}

TEST_P(RecordedPlaneClouds, DecodeToTheBitsThatWereEncodedOnEveryFrame) {
  QuadtreeFitter fitter(camera_, {});
  CodecOptions options;
  for (const auto& file : recordedDepthFiles(GetParam())) {
    const Image<float> depth = readRecordedDepth(file);
    options.mask = !options.mask;
    const FittedDepth fitted{fitter.fit(depth.view()), depth.view(), {}};
    const EncodedPlaneCloud encoded = encode(fitted, options);
    const PlaneCloud decoded = decode(encoded);
    ASSERT_EQ(decoded.tiles.size(), fitted.cloud.tiles.size()) << file;
    ASSERT_EQ(encode(decoded, options).bytes, encoded.bytes) << file;
    if (!options.mask) {
      EXPECT_LT(8.0 * static_cast<double>(encoded.bytes.size()),
                16.0 * static_cast<double>(decoded.tiles.size()));
    }
  }
}

TEST_P(RecordedPlaneClouds, HoldTheDepthItselfIn36KilobytesAFrame) {
  double bytes = 0.0;
  for (const Image<float>& depth : recorded_.depth) {
    const EncodedPlaneCloud encoded = encodeDepth(depth.view(), recorded_.camera, {});
    const Image<float> decoded = decodeDepth(encoded).depth;
    for (int y = 0; y < depth.height(); ++y) {
      for (int x = 0; x < depth.width(); ++x) {
        ASSERT_EQ(hasDepth(depth(x, y)) ? depth(x, y) : 0.0F,
                  std::isnan(decoded(x, y)) ? 0.0F : decoded(x, y));
      }
    }
    bytes += static_cast<double>(encoded.bytes.size());
  }
  EXPECT_LT(bytes / static_cast<double>(recorded_.depth.size()), 36000.0);
}

TEST_P(RecordedPlaneClouds, NeverExceedABudgetAndNeverCoverLessForMore) {
  QuadtreeFitter fitter(camera_, {});
  const PlaneCloud cloud = fitter.fit(recorded_.depth.front().view());
  CodecOptions options;
  double coverage = 0.0;
  for (options.byte_budget = 300; options.byte_budget < 50000; options.byte_budget += 331) {
    const EncodedPlaneCloud encoded = encode(cloud, options);
    ASSERT_LE(encoded.bytes.size(), static_cast<std::size_t>(options.byte_budget));
    ASSERT_GE(encoded.statistics.coverage, coverage) << options.byte_budget;
    coverage = encoded.statistics.coverage;
    if (!encoded.statistics.stopped_by_bytes) break;
  }
  EXPECT_EQ(coverage, cloud.statistics.coverage);
}

INSTANTIATE_TEST_SUITE_P(Sequences, RecordedPlaneClouds,
                         testing::Values("tum_fr1_xyz_first_300", "tum_fr3_cabinet_58"));

}  // namespace
}  // namespace planecloud
