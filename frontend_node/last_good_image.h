// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planecloud_slam/frontend_node/dense_tracker.h"
#include "planecloud_slam/frontend_node/keyframe_view.h"
#include "planecloud_slam/frontend_node/open_keyframe.h"
#include "planecloud_slam/frontend_node/relocaliser.h"

namespace planecloud {

/// The last image tracked against a keyframe: a camera that was lost after it may be found at it
/// when it no longer sees enough of the keyframe itself.
class LastGoodImage {
 public:
  /// An image was aligned to the keyframe.
  void set(const Alignment& alignment);
  /// The keyframe is another: no image was aligned to it yet.
  void forget() { *this = LastGoodImage(); }

  [[nodiscard]] bool isSet() const { return is_set_; }
  /// The image, whose pyramid is `pyramid`, as a place to look for a camera at
  /// `T_keyframe_live`. Requires isSet().
  [[nodiscard]] ExpectedPlace place(const KeyframeView& keyframe, const RgbdPyramid& pyramid,
                                    const DenseTrackerOptions& options,
                                    const std::vector<Eigen::Isometry3d>& T_keyframe_live);

  /// It was found at this place.
  [[nodiscard]] bool isAt(const Relocalisation& found) const {
    return image_.view && found.view == image_.view;
  }
  /// The alignment to this image as one to the keyframe: both motions, both errors.
  [[nodiscard]] Alignment toKeyframe(Alignment to_image) const;

 private:
  bool is_set_ = false;
  Eigen::Isometry3d T_keyframe_image_ = Eigen::Isometry3d::Identity();
  Matrix6d information_ = Matrix6d::Zero();  ///< of T_keyframe_image_
  TrackedReference image_;                   ///< made when it is first asked for
};

}  // namespace planecloud
