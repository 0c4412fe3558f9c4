// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/plane_cloud.h"

#include <stdexcept>

namespace planecloud {

Eigen::Vector4d PlanarTile::plane() const {
  // q = alpha u + beta v + gamma times z: (alpha beta gamma) . p = 1, so d = 1 / norm and
  // (a b c) = -d (alpha beta gamma) (paper eq. (3)).
  const Eigen::Vector3d coefficients = inverse_depth.cast<double>();
  const double d = 1.0 / coefficients.norm();
  Eigen::Vector4d pi;
  pi << -d * coefficients, d;
  return pi;
}

std::string toString(PlaneCloudEncoding encoding) {
  switch (encoding) {
    case PlaneCloudEncoding::kRaw:
      return "raw";
    case PlaneCloudEncoding::kLossless:
      return "lossless";
    case PlaneCloudEncoding::kCompact:
      break;
  }
  return "compact";
}

void fromString(const std::string& text, PlaneCloudEncoding& encoding) {
  for (const PlaneCloudEncoding candidate :
       {PlaneCloudEncoding::kRaw, PlaneCloudEncoding::kCompact, PlaneCloudEncoding::kLossless}) {
    if (text != toString(candidate)) continue;
    encoding = candidate;
    return;
  }
  throw std::invalid_argument("encoding '" + text + "': must be raw, compact or lossless");
}

}  // namespace planecloud
