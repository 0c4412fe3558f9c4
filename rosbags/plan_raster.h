// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "planecloud_slam/rosbags/plan_canvas.h"
#include "planecloud_slam/rosbags/surface_samples.h"

namespace planecloud {

/// Paints surfaces as a plan from above, 8UC3, blue first, `layout`'s rectangle at twice its
/// resolution: floor in thin, furniture in stronger tints of the robots' colours, walls dark where
/// much of them was seen; ceilings are left out.
[[nodiscard]] cv::Mat paintPlan(const std::vector<SurfaceSample>& samples,
                                const std::vector<PlanColor>& robot_colors,
                                const PlanLayout& layout);

}  // namespace planecloud
