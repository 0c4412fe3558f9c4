// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/rgbd_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace planecloud {
namespace {

/// Depths of one surface differ by less than this share within 2x2 pixels.
constexpr float kMergeSpread = 0.05F;

/// Inverse depth of four depths [m], 0 for none: mean over the nearest surface among them.
float mergeDepths(const std::array<float, 4>& z) {
  const float far = std::max(std::max(z[0], z[1]), std::max(z[2], z[3]));
  const float low = std::min(std::min(z[0], z[1]), std::min(z[2], z[3]));
  if (low > 0.0F && far - low < kMergeSpread * low) return 4.0F / (z[0] + z[1] + z[2] + z[3]);
  if (!(far > 0.0F)) return 0.0F;
  float near = far;
  for (const float depth : z) {
    if (depth > 0.0F) near = std::min(near, depth);
  }
  float sum = 0.0F;
  float count = 0.0F;
  for (const float depth : z) {
    if (depth <= 0.0F || depth - near >= kMergeSpread * near) continue;
    sum += depth;
    count += 1.0F;
  }
  return count / sum;
}

/// The same for four inverse depths [1/m].
float mergeInverseDepths(const std::array<float, 4>& q) {
  const float near = std::max(std::max(q[0], q[1]), std::max(q[2], q[3]));
  if (!(near > 0.0F)) return 0.0F;
  float sum = 0.0F;
  float count = 0.0F;
  for (const float inverse_depth : q) {
    if (near - inverse_depth >= 2.0F * kMergeSpread * near) continue;
    sum += inverse_depth;
    count += 1.0F;
  }
  return sum / count;
}

RgbdLevel makeLevel(const CameraIntrinsics& camera, int halvings) {
  RgbdLevel level;
  level.camera = levelCamera(camera, halvings);
  level.pixels.resize(level.camera.width, level.camera.height);
  return level;
}

void halve(const RgbdLevel& fine, RgbdLevel& coarse) {
  for (int y = 0; y < coarse.camera.height; ++y) {
    const GreyDepth* upper = fine.pixels.row(2 * y);
    const GreyDepth* lower = fine.pixels.row(2 * y + 1);
    GreyDepth* out = coarse.pixels.row(y);
    for (int x = 0; x < coarse.camera.width; ++x, upper += 2, lower += 2) {
      out[x].grey = 0.25F * (upper[0].grey + upper[1].grey + lower[0].grey + lower[1].grey);
      out[x].inverse_depth = mergeInverseDepths({upper[0].inverse_depth, upper[1].inverse_depth,
                                                 lower[0].inverse_depth, lower[1].inverse_depth});
    }
  }
}

}  // namespace

LevelCamera levelCamera(const CameraIntrinsics& camera, int halvings) {
  const double scale = 1.0 / static_cast<double>(1 << halvings);
  LevelCamera level;
  level.width = camera.width >> halvings;
  level.height = camera.height >> halvings;
  level.fx = static_cast<float>(camera.fx * scale);
  level.fy = static_cast<float>(camera.fy * scale);
  level.cx = static_cast<float>((camera.cx + 0.5) * scale - 0.5);
  level.cy = static_cast<float>((camera.cy + 0.5) * scale - 0.5);
  return level;
}

RgbdPyramid::RgbdPyramid(const CameraIntrinsics& camera, const DenseTrackerOptions& options)
    : min_depth_(static_cast<float>(options.min_depth)),
      max_depth_(static_cast<float>(options.max_depth)),
      first_halvings_(0) {
  options.check();
  camera.check();
  if (camera.hasDistortion()) {
    throw std::invalid_argument("tracking needs a camera without distortion: rectify the images");
  }
  while ((camera.width >> first_halvings_) > options.finest_width) ++first_halvings_;
  const int last = first_halvings_ + options.levels - 1;
  if ((camera.width >> last) < 16 || (camera.height >> last) < 12) {
    throw std::invalid_argument("tracking/levels = " + std::to_string(options.levels) +
                                ": the coarsest level would be smaller than 16 x 12 pixels, "
                                "use fewer levels or a larger tracking/finest_width");
  }
  for (int halvings = 1; halvings < first_halvings_; ++halvings) {
    finer_.push_back(makeLevel(camera, halvings));
  }
  for (int halvings = first_halvings_; halvings <= last; ++halvings) {
    levels_.push_back(makeLevel(camera, halvings));
  }
}

void RgbdPyramid::assign(ImageView<std::uint8_t> grey, ImageView<float> depth) {
  const auto usable = [this](float z) { return z >= min_depth_ && z <= max_depth_ ? z : 0.0F; };
  RgbdLevel& first = finer_.empty() ? levels_.front() : finer_.front();
  for (int y = 0; y < first.camera.height; ++y) {
    GreyDepth* out = first.pixels.row(y);
    if (first_halvings_ == 0) {
      for (int x = 0; x < first.camera.width; ++x) {
        const float z = usable(depth(x, y));
        out[x] = {static_cast<float>(grey(x, y)), z > 0.0F ? 1.0F / z : 0.0F};
      }
      continue;
    }
    const std::uint8_t* grey0 = grey.row(2 * y);
    const std::uint8_t* grey1 = grey.row(2 * y + 1);
    const float* depth0 = depth.row(2 * y);
    const float* depth1 = depth.row(2 * y + 1);
    for (int x = 0; x < first.camera.width; ++x) {
      const int x2 = 2 * x;
      const int sum = grey0[x2] + grey0[x2 + 1] + grey1[x2] + grey1[x2 + 1];
      out[x].grey = 0.25F * static_cast<float>(sum);
      out[x].inverse_depth = mergeDepths(
          {usable(depth0[x2]), usable(depth0[x2 + 1]), usable(depth1[x2]), usable(depth1[x2 + 1])});
    }
  }
  for (std::size_t i = 1; i < finer_.size(); ++i) halve(finer_[i - 1], finer_[i]);
  if (!finer_.empty()) halve(finer_.back(), levels_.front());
  for (std::size_t i = 1; i < levels_.size(); ++i) halve(levels_[i - 1], levels_[i]);
}

}  // namespace planecloud
