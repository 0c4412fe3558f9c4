// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/icap/alignment_steps.h"

/// What the views say of an alignment that their planes do not: past the edge of a surface one view
/// sees through what the other saw.
namespace planecloud {

/// Share of what each view should see of the other that it does see, mean of both ways, [0, 1];
/// less when the views hardly meet.
[[nodiscard]] double viewSupport(const PlaneSetPair& pair, const Eigen::Isometry3d& T_target_source,
                                 const VisibilityOptions& options);

/// By how much likelier the support of one answer makes it than that of another one [nat].
[[nodiscard]] double supportGain(double support, double other_support);

/// What has to be gained to leave an answer for another one [nat].
constexpr double kLeastSupportGain = 2.0;

/// Moves the answer along the direction that the planes know least, to and fro, to where the views
/// support it most, and lets it settle there. Planes that know well are left alone.
void slideToSupport(const PlaneSetPair& pair, const IcapOptions& options,
                    AlignmentProgress& progress);

}  // namespace planecloud
