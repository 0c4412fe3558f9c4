// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// More seeds and shares: bench_backend_closures.
#include <gtest/gtest.h>

#include "false_closures.h"

namespace planecloud {
namespace {

TEST(FalseClosures, DoNotBendTheMap) {
  const FalseClosureResult none = runFalseClosures({0.0, 1});
  const FalseClosureResult third = runFalseClosures({0.3, 1});
  ASSERT_GT(third.offered_false, 20);
  EXPECT_LE(third.ate, 1.2 * none.ate);
  EXPECT_GT(none.kept_true, none.offered_true / 2);
}

}  // namespace
}  // namespace planecloud
