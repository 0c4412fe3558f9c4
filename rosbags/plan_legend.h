// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "planecloud_slam/rosbags/plan_canvas.h"

namespace planecloud {

/// Title in large letters above the plan, a line of figures below it.
void drawHeader(PlanCanvas& canvas, const PlanLayout& layout, const std::string& title,
                const std::string& subtitle);

/// A bar of a round length, with its length, at the right below the plan.
void drawScaleBar(PlanCanvas& canvas, const PlanLayout& layout);

/// What a line in the plan means.
struct LegendEntry {
  std::string label;
  PlanStroke stroke;
};

/// The entries in rows below the plan, left of the scale bar.
void drawLegend(PlanCanvas& canvas, const PlanLayout& layout,
                const std::vector<LegendEntry>& entries);

}  // namespace planecloud
