// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/compression_source.h"

#include <deque>
#include <utility>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/rosbags/color_image.h"

namespace planecloud {
namespace {

/// The images that a selection takes.
class SelectedImages : public CompressionSource {
 public:
  SelectedImages(std::shared_ptr<Recording> recording, const CompressionSelection& selection)
      : recording_(std::move(recording)), selection_(selection) {}

  [[nodiscard]] CameraIntrinsics camera() const override { return recording_->camera(); }
  [[nodiscard]] std::size_t imagesRead() const override { return read_; }

  [[nodiscard]] std::optional<CompressionItem> next() override {
    if (selection_.max_images > 0 && taken_ == selection_.max_images) return std::nullopt;
    while (std::optional<RgbdFrame> frame = recording_->next()) {
      if (read_++ % selection_.every != 0) continue;
      ++taken_;
      CompressionItem item;
      item.color = recording_->color();
      item.true_depth = recording_->trueDepth();
      item.frame = std::move(*frame);
      if (selection_.color) item.frame.color = toRgb8(item.color);
      return item;
    }
    return std::nullopt;
  }

 private:
  const std::shared_ptr<Recording> recording_;
  const CompressionSelection selection_;
  std::size_t read_ = 0;
  std::size_t taken_ = 0;
};

/// The keyframes of a frontend that tracks the selected images.
class TrackedKeyframes : public CompressionSource {
 public:
  TrackedKeyframes(std::shared_ptr<Recording> recording, const CompressionSelection& selection,
                   const FrontendOptions& options)
      : camera_(recording->camera().rectified()),
        frontend_(options, recording->camera(), recording->robot(), 1),
        images_(std::move(recording), selection) {}

  [[nodiscard]] CameraIntrinsics camera() const override { return camera_; }
  [[nodiscard]] std::size_t imagesRead() const override { return images_.imagesRead(); }

  [[nodiscard]] std::optional<CompressionItem> next() override {
    while (completed_.empty() && !ended_) {
      std::optional<CompressionItem> image = images_.next();
      if (image) {
        static_cast<void>(frontend_.track(image->frame));
        image->frame.grey = {};  // the keyframe keeps its own
        image->frame.color = {};
        opened_.push_back(std::move(*image));
      } else {
        frontend_.finish();
        ended_ = true;
      }
      for (CompletedKeyframe& keyframe : frontend_.takeCompleted()) {
        completed_.push_back(std::move(keyframe));
      }
    }
    if (completed_.empty()) return std::nullopt;
    CompressionItem item = itemOf(std::move(completed_.front()));
    completed_.pop_front();
    return item;
  }

 private:
  /// A keyframe and the image it was opened with.
  CompressionItem itemOf(CompletedKeyframe keyframe) {
    while (opened_.front().frame.stamp != keyframe.keyframe.stamp) opened_.pop_front();
    CompressionItem item = std::move(opened_.front());
    opened_.pop_front();
    // Lens distortion would make the sensor's image another one than the keyframe's.
    if (keyframe.camera == frontendCamera()) item.raw_depth = std::move(item.frame.depth);
    item.frame.grey = std::move(keyframe.grey);
    item.frame.depth = std::move(keyframe.depth);
    item.frame.color = std::move(keyframe.color);
    return item;
  }

  [[nodiscard]] CameraIntrinsics frontendCamera() const { return images_.camera(); }

  const CameraIntrinsics camera_;
  Frontend frontend_;
  SelectedImages images_;
  std::deque<CompressionItem> opened_;  ///< images that keyframes not yet taken may begin with
  std::deque<CompletedKeyframe> completed_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<CompressionSource> makeCompressionSource(std::shared_ptr<Recording> recording,
                                                         const CompressionSelection& selection,
                                                         const FrontendOptions& options) {
  if (!selection.keyframes) return std::make_unique<SelectedImages>(recording, selection);
  return std::make_unique<TrackedKeyframes>(std::move(recording), selection, options);
}

}  // namespace planecloud
