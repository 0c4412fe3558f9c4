// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud_slam {

/// How live frames update the depth of the open keyframe.
struct LocalMapOptions {
  bool fuse = true;           ///< false: the keyframe keeps the depth it was opened with
  double sigma = 0.003;       ///< standard deviation of one inverse depth [1/m], [1e-5, 1]
  double gate = 3.0;          ///< fuse within this many standard deviations, [0.5, 20]
  int max_observations = 30;  ///< frames that count in a pixel's mean at most, [1, 1000]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("fuse", self.fuse);
    visit("sigma", self.sigma);
    visit("gate", self.gate);
    visit("max_observations", self.max_observations);
  }

  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

}  // namespace planecloud_slam
