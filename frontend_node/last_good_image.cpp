// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/last_good_image.h"

#include <memory>

namespace planecloud {

void LastGoodImage::set(const Alignment& alignment) {
  T_keyframe_image_ = alignment.T_reference_current;
  information_ = alignment.information;
  image_ = {};
  is_set_ = true;
}

ExpectedPlace LastGoodImage::place(const KeyframeView& keyframe, const RgbdPyramid& pyramid,
                                   const DenseTrackerOptions& options,
                                   const std::vector<Eigen::Isometry3d>& T_keyframe_live) {
  if (!image_.view) {
    image_.view = std::make_shared<const KeyframeView>(KeyframeView{
        keyframe.id, keyframe.segment, keyframe.T_odom_camera * T_keyframe_image_, pyramid, {}});
    image_.points = std::make_shared<const TrackingReference>(pyramid, options);
  }
  ExpectedPlace place{image_.view, image_.points, {}};
  const Eigen::Isometry3d T_image_keyframe = T_keyframe_image_.inverse();
  for (const Eigen::Isometry3d& T : T_keyframe_live) {
    place.T_view_live.push_back(T_image_keyframe * T);
  }
  return place;
}

Alignment LastGoodImage::toKeyframe(Alignment to_image) const {
  const Eigen::Isometry3d& T_image_live = to_image.T_reference_current;
  const Matrix6d covariance = transformCovariance(T_image_live.inverse(), information_.inverse()) +
                              to_image.information.inverse();
  to_image.information = covariance.inverse();
  to_image.T_reference_current = T_keyframe_image_ * T_image_live;
  return to_image;
}

}  // namespace planecloud
