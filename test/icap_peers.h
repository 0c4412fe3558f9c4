// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"

/// What ICaP is compared with: PCL's point-to-plane ICP and generalised ICP on the dense clouds.
namespace planecloud {

/// A depth image as the two peers want it: points on a grid of 3 and 4 cm, with normals and with
/// covariances, and the time these took apart from the voxels [s].
class DenseView {
 public:
  DenseView(const Image<float>& depth, const CameraIntrinsics& camera);
  ~DenseView();
  DenseView(DenseView&&) noexcept;
  DenseView& operator=(DenseView&&) noexcept;

  [[nodiscard]] double normalsTime() const;
  [[nodiscard]] double covariancesTime() const;

  struct Clouds;
  [[nodiscard]] const Clouds& clouds() const { return *clouds_; }

 private:
  std::unique_ptr<Clouds> clouds_;
};

/// Point-to-plane ICP on 3 cm voxels; building the search tree is part of it, normals are not.
[[nodiscard]] Eigen::Isometry3d alignPointToPlane(const DenseView& target, const DenseView& source,
                                                  const Eigen::Isometry3d& T_target_source_guess);

/// Generalised ICP on 4 cm voxels, likewise without the covariances.
[[nodiscard]] Eigen::Isometry3d alignGeneralised(const DenseView& target, const DenseView& source,
                                                 const Eigen::Isometry3d& T_target_source_guess);

}  // namespace planecloud
