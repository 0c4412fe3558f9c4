// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/keyframe_compressor.h"

#include <utility>

#include "planecloud_slam/plane_fit/appearance_descriptor.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

namespace planecloud {

class KeyframeCompressor::Impl {
 public:
  explicit Impl(const FrontendOptions& options) : options_(options) { options_.check(); }

  Keyframe compress(CompletedKeyframe completed,
                    std::function<FitBudget::Clock::time_point()> now) {
    Keyframe keyframe = std::move(completed.keyframe);
    const PlaneCloud cloud =
        fitterOf(completed.camera).fit(completed.depth.view(), budget(std::move(now)));
    keyframe.planes = encode(cloud, options_.codec);
    keyframe.descriptor = makeAppearanceDescriptor(completed.grey.view(), completed.depth.view());
    return keyframe;
  }

 private:
  QuadtreeFitter& fitterOf(const CameraIntrinsics& camera) {
    if (!fitter_ || fitter_->camera().intrinsics() != camera) {
      fitter_.emplace(std::make_shared<const Camera>(camera), options_.plane_fit);
    }
    return *fitter_;
  }

  FitBudget budget(std::function<FitBudget::Clock::time_point()> now) const {
    FitBudget budget;
    if (now) budget = FitBudget::fromNow(options_.plane_fit.time_budget, std::move(now));
    if (options_.plane_fit.byte_budget > 0) {
      budget.bytes = static_cast<std::size_t>(options_.plane_fit.byte_budget);
    }
    return budget;
  }

  FrontendOptions options_;
  std::optional<QuadtreeFitter> fitter_;
};

KeyframeCompressor::KeyframeCompressor(const FrontendOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
KeyframeCompressor::~KeyframeCompressor() = default;
KeyframeCompressor::KeyframeCompressor(KeyframeCompressor&&) noexcept = default;
KeyframeCompressor& KeyframeCompressor::operator=(KeyframeCompressor&&) noexcept = default;

Keyframe KeyframeCompressor::compress(CompletedKeyframe completed,
                                      std::function<FitBudget::Clock::time_point()> now) {
  return impl_->compress(std::move(completed), std::move(now));
}

}  // namespace planecloud
