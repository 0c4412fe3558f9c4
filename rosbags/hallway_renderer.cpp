// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_renderer.h"

#include <algorithm>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <utility>

namespace planecloud {
namespace {

/// Where the four rays of an edge pixel go, on a rotated grid [px].
constexpr float kEdgeSamples[4][2] = {
    {-0.125F, -0.375F}, {0.375F, -0.125F}, {0.125F, 0.375F}, {-0.375F, 0.125F}};

template <typename Body>
void forEachTileRow(int rows, const Body& body) {
  cv::parallel_for_(cv::Range(0, rows), [&](const cv::Range& range) {
    for (int row = range.start; row < range.end; ++row) body(row);
  });
}

/// Glass and lamps send no structured light back.
bool answers(const HallwayWorld& world, const PlacedSolid& placed) {
  const auto material = static_cast<std::size_t>(placed.solid().material);
  const Material::Kind kind = world.materials()[material].kind;
  return kind != Material::Kind::kGlass && kind != Material::Kind::kLamp;
}

}  // namespace

HallwayRenderer::HallwayRenderer(std::shared_ptr<const HallwayWorld> world,
                                 const CameraIntrinsics& camera)
    : world_(std::move(world)), camera_(camera) {
  if (camera.distortion != CameraIntrinsics{}.distortion) {
    throw std::invalid_argument("the built-in world is rendered without lens distortion");
  }
  tile_columns_ = (camera.width + kTileSide - 1) / kTileSide;
  tile_rows_ = (camera.height + kTileSide - 1) / kTileSide;
  for (int x = 0; x < tile_columns_ * kTileSide; ++x) {
    tangents_x_.push_back(static_cast<float>((x - camera.cx) / camera.fx));
  }
  pitch_ = {static_cast<float>(1.0 / camera.fx), static_cast<float>(1.0 / camera.fy)};
  candidates_.resize(static_cast<std::size_t>(tile_columns_ * tile_rows_));
  surfaces_ = Image<std::int32_t>(camera.width, camera.height, -1);
}

RenderedView HallwayRenderer::render(const Eigen::Isometry3d& T_world_camera) {
  RenderedView view;
  view.color = Image<Eigen::Array3f>(camera_.width, camera_.height, Eigen::Array3f::Zero());
  view.depth = Image<float>(camera_.width, camera_.height, std::numeric_limits<float>::quiet_NaN());
  view.incidence = Image<float>(camera_.width, camera_.height, 0.0F);
  place(T_world_camera);
  forEachTileRow(tile_rows_, [&](int row) { castTileRow(row, view); });
  forEachTileRow(tile_rows_, [&](int row) { smoothEdges(row, view); });
  return view;
}

void HallwayRenderer::place(const Eigen::Isometry3d& T_world_camera) {
  placed_.clear();
  for (const Solid& solid : world_->solids()) {
    const PlacedSolid placed(solid, T_world_camera, camera_);
    if (placed.visible()) placed_.push_back(placed);
  }
  std::stable_sort(placed_.begin(), placed_.end(), [](const PlacedSolid& a, const PlacedSolid& b) {
    return a.nearest() < b.nearest();
  });
  for (std::vector<int>& list : candidates_) list.clear();
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const Eigen::Array2i first = placed_[i].firstPixel() / kTileSide;
    const Eigen::Array2i last = placed_[i].lastPixel() / kTileSide;
    for (int row = first.y(); row <= last.y(); ++row) {
      for (int column = first.x(); column <= last.x(); ++column) {
        candidates_[static_cast<std::size_t>(row * tile_columns_ + column)].push_back(
            static_cast<int>(i));
      }
    }
  }
}

void HallwayRenderer::castTileRow(int tile_row, RenderedView& view) {
  const int last_y = std::min((tile_row + 1) * kTileSide, camera_.height);
  for (int tile = 0; tile < tile_columns_; ++tile) {
    RayRow rays;
    std::copy_n(tangents_x_.begin() + tile * kTileSide, kTileSide, rays.u);
    for (int y = tile_row * kTileSide; y < last_y; ++y) {
      rays.v = tangentY(static_cast<float>(y));
      std::fill_n(rays.depth, kTileSide, std::numeric_limits<float>::infinity());
      std::fill_n(rays.solid, kTileSide, -1);
      for (const int index : candidates(tile, tile_row)) {
        const PlacedSolid& placed = placed_[static_cast<std::size_t>(index)];
        if (placed.nearest() > *std::max_element(rays.depth, rays.depth + kTileSide)) break;
        placed.intersect(rays, index);
      }
      enterRow(rays, tile * kTileSide, y, view);
    }
  }
}

void HallwayRenderer::enterRow(const RayRow& rays, int first_x, int y, RenderedView& view) {
  const int count = std::min(kTileSide, camera_.width - first_x);
  for (int i = 0; i < count; ++i) {
    const int x = first_x + i;
    if (rays.solid[i] < 0) {
      surfaces_(x, y) = -1;
      continue;
    }
    const PlacedSolid& placed = placed_[static_cast<std::size_t>(rays.solid[i])];
    const SurfaceHit hit = placed.surfaceAt({rays.u[i], rays.v}, rays.depth[i]);
    surfaces_(x, y) = 8 * rays.solid[i] + hit.face;
    view.depth(x, y) = hit.depth;
    view.color(x, y) = shade(*world_, placed, hit, pitch_);
    view.incidence(x, y) =
        answers(*world_, placed) ? -hit.normal.dot(hit.direction) / hit.direction.norm() : 0.0F;
  }
}

void HallwayRenderer::smoothEdges(int tile_row, RenderedView& view) const {
  const int last_y = std::min((tile_row + 1) * kTileSide, camera_.height);
  for (int y = tile_row * kTileSide; y < last_y; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      if (isEdge(x, y)) view.color(x, y) = edgeColor(x, y);
    }
  }
}

bool HallwayRenderer::isEdge(int x, int y) const {
  const std::int32_t surface = surfaces_(x, y);
  return (x > 0 && surfaces_(x - 1, y) != surface) ||
         (x + 1 < camera_.width && surfaces_(x + 1, y) != surface) ||
         (y > 0 && surfaces_(x, y - 1) != surface) ||
         (y + 1 < camera_.height && surfaces_(x, y + 1) != surface);
}

Eigen::Array3f HallwayRenderer::edgeColor(int x, int y) const {
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  for (const auto& offset : kEdgeSamples) {
    const ImageRay ray{tangents_x_[static_cast<std::size_t>(x)] + offset[0] * pitch_.x,
                       tangentY(static_cast<float>(y) + offset[1])};
    float nearest = std::numeric_limits<float>::infinity();
    const PlacedSolid* seen = nullptr;
    for (const int index : candidates(x / kTileSide, y / kTileSide)) {
      const PlacedSolid& placed = placed_[static_cast<std::size_t>(index)];
      if (placed.nearest() > nearest) break;
      const float depth = placed.intersect(ray);
      if (depth >= nearest) continue;
      nearest = depth;
      seen = &placed;
    }
    if (seen == nullptr) continue;
    const PixelPitch half{0.5F * pitch_.x, 0.5F * pitch_.y};
    sum += 0.25F * shade(*world_, *seen, seen->surfaceAt(ray, nearest), half);
  }
  return sum;
}

}  // namespace planecloud
