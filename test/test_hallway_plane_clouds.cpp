// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "planecloud_slam/plane_fit/fitted_depth.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/rosbags/hallway_recording.h"

/// Fitting and coding what the built-in sensor sees.
namespace planecloud {
namespace {

void expectDecodedAsEncoded(double duration) {
  HallwayOptions options;
  options.seed = 2;
  options.duration = duration;
  HallwayRecording recording(options);
  QuadtreeFitter fitter(std::make_shared<const Camera>(recording.camera()), {});
  CodecOptions codec;
  while (const std::optional<RgbdFrame> frame = recording.next()) {
    codec.mask = !codec.mask;
    const FittedDepth fitted{fitter.fit(frame->depth.view()), frame->depth.view(), {}};
    const EncodedPlaneCloud encoded = encode(fitted, codec);
    const PlaneCloud decoded = decode(encoded);
    ASSERT_EQ(decoded.tiles.size(), fitted.cloud.tiles.size());
    ASSERT_EQ(encode(decoded, codec).bytes, encoded.bytes);
  }
}

TEST(HallwayPlaneClouds, DecodeToTheBitsThatWereEncoded) { expectDecodedAsEncoded(2.0); }

/// Minutes; with --gtest_also_run_disabled_tests.
TEST(HallwayPlaneClouds, DISABLED_DecodeToTheBitsThatWereEncodedOnEveryFrame) {
  expectDecodedAsEncoded(84.0);
}

}  // namespace
}  // namespace planecloud
