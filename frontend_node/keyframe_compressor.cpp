// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/keyframe_compressor.h"

#include <utility>

#include "planecloud_slam/frontend_node/history_aligner.h"
#include "planecloud_slam/frontend_node/keyframe_payload.h"
#include "planecloud_slam/plane_fit/appearance_descriptor.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

namespace planecloud {

class KeyframeCompressor::Impl {
 public:
  explicit Impl(const FrontendOptions& options)
      : options_(options), history_(options.history, options.tracking) {
    options_.check();
  }

  Keyframe compress(CompletedKeyframe completed, const KeyframeBudget& budget) {
    Keyframe keyframe = std::move(completed.keyframe);
    PlaneCloud cloud = fitterOf(completed.camera).fit(completed.depth.view(), fitBudget(budget));
    KeyframePayload payload =
        encodePayload({std::move(cloud), completed.depth.view(), options_.plane_fit},
                      {completed.grey.view(), completed.color.view()},
                      {options_.codec, options_.texture}, budget.bytes);
    keyframe.planes = std::move(payload.planes);
    keyframe.texture = std::move(payload.texture);
    HistoryLinks links = history_.align(completed.history, keyframe.edges);
    keyframe.edges.insert(keyframe.edges.end(), links.edges.begin(), links.edges.end());
    keyframe.closure_hints = std::move(links.hints);
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

  [[nodiscard]] FitBudget fitBudget(const KeyframeBudget& budget) const {
    FitBudget fit;
    if (budget.now) fit = FitBudget::fromNow(options_.plane_fit.time_budget, budget.now);
    if (options_.plane_fit.byte_budget > 0) {
      fit.bytes = static_cast<std::size_t>(options_.plane_fit.byte_budget);
    }
    return fit;
  }

  FrontendOptions options_;
  HistoryAligner history_;
  std::optional<QuadtreeFitter> fitter_;
};

KeyframeCompressor::KeyframeCompressor(const FrontendOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
void KeyframeCompressor::setOptions(const FrontendOptions& options) {
  impl_ = std::make_unique<Impl>(options);
}
KeyframeCompressor::~KeyframeCompressor() = default;
KeyframeCompressor::KeyframeCompressor(KeyframeCompressor&&) noexcept = default;
KeyframeCompressor& KeyframeCompressor::operator=(KeyframeCompressor&&) noexcept = default;

Keyframe KeyframeCompressor::compress(CompletedKeyframe completed, const KeyframeBudget& budget) {
  return impl_->compress(std::move(completed), budget);
}

}  // namespace planecloud
