// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/moment_pyramid.h"

namespace planecloud {

/// Makes every node of a pyramid ready to be asked about.
inline void splitAll(MomentPyramid& pyramid) {
  const QuadtreeGrid& grid = pyramid.grid();
  for (int level = 0; level + 1 < grid.levels(); ++level) {
    for (int row = 0; row < grid.rows(level); ++row) {
      for (int column = 0; column < grid.columns(level); ++column) {
        pyramid.split({level, column, row});
      }
    }
  }
}

}  // namespace planecloud
