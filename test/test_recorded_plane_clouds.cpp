// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <memory>
#include <string>

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

TEST_P(RecordedPlaneClouds, DecodeToTheBitsThatWereEncoded) {
  QuadtreeFitter fitter(camera_, {});
  for (const Image<float>& depth : recorded_.depth) {
    const PlaneCloud cloud = fitter.fit(depth.view());
    const EncodedPlaneCloud encoded = encode(cloud, {});
    const PlaneCloud decoded = decode(encoded);
    ASSERT_EQ(decoded.tiles.size(), cloud.tiles.size());
    EXPECT_EQ(encode(decoded, {}).bytes, encoded.bytes);
    EXPECT_LT(8.0 * static_cast<double>(encoded.bytes.size()),
              26.0 * static_cast<double>(cloud.tiles.size()));
  }
}

INSTANTIATE_TEST_SUITE_P(Sequences, RecordedPlaneClouds,
                         testing::Values("tum_fr1_xyz_first_300", "tum_fr3_cabinet_58"));

}  // namespace
}  // namespace planecloud
