// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <planecloud_slam/CodecConfig.h>
#include <planecloud_slam/KeyframeConfig.h>
#include <planecloud_slam/LinkConfig.h>
#include <planecloud_slam/PlaneFitConfig.h>
#include <planecloud_slam/TextureConfig.h>

#include <cmath>
#include <limits>

#include "planecloud_slam/frontend_node/frontend_node_options.h"

// What dynamic_reconfigure offers are the code's defaults and ranges.
namespace planecloud {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

int beyond(int value, int direction) { return value + direction; }
double beyond(double value, int direction) { return std::nextafter(value, direction * kInfinity); }

/// `Config::*live` stands for `Options::*option`: same default, and its ends are where the check
/// begins to refuse.
template <typename Config, typename Options, typename Number>
void expectRange(Number Config::*live, Number Options::*option) {
  EXPECT_EQ(Config::__getDefault__().*live, Options().*option);
  for (const int direction : {-1, 1}) {
    Options options;
    options.*option = (direction < 0 ? Config::__getMin__() : Config::__getMax__()).*live;
    EXPECT_NO_THROW(options.check());
    options.*option = beyond(options.*option, direction);
    EXPECT_THROW(options.check(), std::invalid_argument) << options.*option;
  }
}

TEST(LiveOptions, OfThePlaneFitAreTheCodes) {
  using Config = planecloud_slam::PlaneFitConfig;
  expectRange(&Config::time_budget, &QuadtreeFitterOptions::time_budget);
  expectRange(&Config::tolerance, &QuadtreeFitterOptions::tolerance);
}

TEST(LiveOptions, OfTheCodecAreTheCodes) {
  expectRange(&planecloud_slam::CodecConfig::byte_budget, &CodecOptions::byte_budget);
}

TEST(LiveOptions, OfTheLinkAreTheCodes) {
  expectRange(&planecloud_slam::LinkConfig::bytes_per_second, &LinkOptions::bytes_per_second);
}

TEST(LiveOptions, OfTheTextureAreTheCodes) {
  using Config = planecloud_slam::TextureConfig;
  expectRange(&Config::scale, &TextureOptions::scale);
  expectRange(&Config::quality, &TextureOptions::quality);
  expectRange(&Config::max_share, &TextureOptions::max_share);
  EXPECT_EQ(Config::__getDefault__().format, toString(TextureOptions().format));
}

TEST(LiveOptions, OfKeyframesAreTheCodes) {
  using Config = planecloud_slam::KeyframeConfig;
  expectRange(&Config::max_translation, &KeyframeSelectorOptions::max_translation);
  expectRange(&Config::max_rotation, &KeyframeSelectorOptions::max_rotation);
  expectRange(&Config::min_entropy_ratio, &KeyframeSelectorOptions::min_entropy_ratio);
  expectRange(&Config::min_overlap, &KeyframeSelectorOptions::min_overlap);
}

}  // namespace
}  // namespace planecloud
