// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/tracking_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace planecloud {
namespace {

/// Inverse depths of one surface differ by less than this share within the fitted window.
constexpr float kEdgeSpread = 0.1F;
constexpr int kWindowRadius = 2;
constexpr int kMinWindowPixels = 10;
/// A plane replaces the inverse depth of a window when it differs by less than its noise [1/m].
constexpr float kPlaneAgreement = 6e-3F;
/// In the place of a squared gradient.
constexpr float kNeverChosen = -1.0F;

/// Inverse depth around a pixel: value [1/m] and slope [1/m per pixel].
struct SurfaceFit {
  float q;
  float q_x;
  float q_y;
};

/// True when a direct neighbour is clearly nearer: the pixel's depth and grey may belong to either
/// side, and what it shows will be covered or uncovered by the next motion.
bool isBehindEdge(const Image<GreyDepth>& pixels, int x, int y) {
  const float limit = (1.0F + kEdgeSpread) * pixels(x, y).inverse_depth;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (pixels(x + dx, y + dy).inverse_depth > limit) return true;
    }
  }
  return false;
}

/// Regression of inverse depth on the window around (x, y), over the pixels of the same surface.
std::optional<SurfaceFit> fitSurface(const Image<GreyDepth>& pixels, int x, int y) {
  const float centre = pixels(x, y).inverse_depth;
  const float tolerance = kEdgeSpread * centre;
  float n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, sq = 0, sxq = 0, syq = 0;
  for (int dy = -kWindowRadius; dy <= kWindowRadius; ++dy) {
    const GreyDepth* row = pixels.row(y + dy) + x;
    const auto fy = static_cast<float>(dy);
    for (int dx = -kWindowRadius; dx <= kWindowRadius; ++dx) {
      const float q = row[dx].inverse_depth - centre;
      if (std::abs(q) > tolerance) continue;
      const auto fx = static_cast<float>(dx);
      n += 1.0F, sx += fx, sy += fy, sq += q;
      sxx += fx * fx, sxy += fx * fy, syy += fy * fy;
      sxq += fx * q, syq += fy * q;
    }
  }
  if (n < static_cast<float>(kMinWindowPixels)) return std::nullopt;
  sxx -= sx * sx / n, sxy -= sx * sy / n, syy -= sy * sy / n;
  sxq -= sx * sq / n, syq -= sy * sq / n;
  const float determinant = sxx * syy - sxy * sxy;
  if (determinant < 0.05F * n * n) return std::nullopt;
  const float q_x = (syy * sxq - sxy * syq) / determinant;
  const float q_y = (sxx * syq - sxy * sxq) / determinant;
  return SurfaceFit{centre + (sq - q_x * sx - q_y * sy) / n, q_x, q_y};
}

/// Takes a surface at pixel (x, y) to the plane that is seen there, if it agrees.
void snapToPlane(const PlaneLandmarks& planes, const LevelCamera& camera, int x, int y,
                 SurfaceFit& fit) {
  const float u = (static_cast<float>(x) - camera.cx) / camera.fx;
  const float v = (static_cast<float>(y) - camera.cy) / camera.fy;
  const Eigen::Vector3f* plane = planes.find(u, v);
  if (plane == nullptr) return;
  const float q = plane->dot(Eigen::Vector3f(u, v, 1.0F));
  if (std::abs(q - fit.q) > kPlaneAgreement) return;
  fit = {q, plane->x() / camera.fx, plane->y() / camera.fy};
}

/// Squared gradient of grey [(levels/px)^2]; 0 on the border the windows cannot reach.
Image<float> squaredGradients(const Image<GreyDepth>& pixels) {
  Image<float> squares(pixels.width(), pixels.height(), 0.0F);
  for (int y = kWindowRadius; y < pixels.height() - kWindowRadius; ++y) {
    const GreyDepth* above = pixels.row(y - 1);
    const GreyDepth* row = pixels.row(y);
    const GreyDepth* below = pixels.row(y + 1);
    for (int x = kWindowRadius; x < pixels.width() - kWindowRadius; ++x) {
      const float gx = 0.5F * (row[x + 1].grey - row[x - 1].grey);
      const float gy = 0.5F * (below[x].grey - above[x].grey);
      squares(x, y) = gx * gx + gy * gy;
    }
  }
  return squares;
}

/// The squared gradient that at most `share` of the pixels exceed, never below `floor` squared.
float gradientThreshold(const Image<float>& squares, double share, double floor) {
  constexpr float kBinsPerLevel = 4.0F;
  std::array<std::size_t, 512> histogram{};
  for (const float square : squares) {
    const auto bin = static_cast<std::size_t>(kBinsPerLevel * std::sqrt(std::max(0.0F, square)));
    ++histogram[std::min(bin, histogram.size() - 1)];
  }
  const auto allowed = static_cast<std::size_t>(share * static_cast<double>(squares.size()));
  std::size_t kept = 0;
  std::size_t bin = histogram.size();
  while (bin > 0 && kept + histogram[bin - 1] <= allowed) kept += histogram[--bin];
  const float threshold =
      std::max(static_cast<float>(bin) / kBinsPerLevel, static_cast<float>(floor));
  return threshold * threshold;
}

/// An earlier image at one level.
class EarlierLevel {
 public:
  EarlierLevel(const EarlierImage& image, std::size_t level)
      : level_(image.pyramid->levels()[level]),
        rotation_(image.T_earlier_this.linear().cast<float>()),
        translation_(image.T_earlier_this.translation().cast<float>()) {}

  /// The point at (u, v, 1) / q lies where all around it farther things were seen.
  [[nodiscard]] bool sawThrough(float u, float v, float q) const {
    const Eigen::Vector3f point = rotation_ * Eigen::Vector3f(u, v, 1.0F) + q * translation_;
    if (!(point.z() > 0.0F)) return false;
    const LevelCamera& camera = level_.camera;
    const float x = camera.fx * point.x() / point.z() + camera.cx + 0.5F;
    const float y = camera.fy * point.y() / point.z() + camera.cy + 0.5F;
    const auto width = static_cast<float>(camera.width - 1);
    const auto height = static_cast<float>(camera.height - 1);
    if (!(x >= 1.0F && x < width && y >= 1.0F && y < height)) return false;
    const float inverse_depth = q / point.z();
    for (int dy = -1; dy <= 1; ++dy) {
      const GreyDepth* row = level_.pixels.row(static_cast<int>(y) + dy) + static_cast<int>(x);
      for (int dx = -1; dx <= 1; ++dx) {
        const float seen = row[dx].inverse_depth;
        if (!(seen > 0.0F && seen < kFarther * inverse_depth)) return false;
      }
    }
    return true;
  }

 private:
  /// Of the inverse depth of what has moved in.
  static constexpr float kFarther = 0.8F;

  const RgbdLevel& level_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
};

/// Pixels of one level on what has moved into the view since an earlier image.
class MovedIn {
 public:
  MovedIn(const RgbdPyramid& pyramid, const std::vector<EarlierImage>& earlier)
      : level_(std::min<std::size_t>(1, pyramid.levels().size() - 1)) {
    if (earlier.empty()) return;
    const RgbdLevel& current = pyramid.levels()[level_];
    const LevelCamera& camera = current.camera;
    pixels_ = Image<std::uint8_t>(camera.width, camera.height, 0);
    for (const EarlierImage& image : earlier) {
      const EarlierLevel seen(image, level_);
      for (int y = 0; y < camera.height; ++y) {
        const float v = (static_cast<float>(y) - camera.cy) / camera.fy;
        for (int x = 0; x < camera.width; ++x) {
          const float q = current.pixels(x, y).inverse_depth;
          if (!(q > 0.0F) || pixels_(x, y) != 0) continue;
          const float u = (static_cast<float>(x) - camera.cx) / camera.fx;
          pixels_(x, y) = seen.sawThrough(u, v, q) ? 1 : 0;
        }
      }
    }
  }
  /// Makes the gradients of such pixels, of any level, `kNeverChosen`.
  void exclude(std::size_t level, Image<float>& squares) const {
    if (pixels_.empty()) return;
    for (int y = 0; y < squares.height(); ++y) {
      for (int x = 0; x < squares.width(); ++x) {
        if (at(level, x, y)) squares(x, y) = kNeverChosen;
      }
    }
  }

 private:
  [[nodiscard]] bool at(std::size_t level, int x, int y) const {
    if (level < level_) return pixels_(x >> 1, y >> 1) != 0;
    const auto finer = static_cast<int>(level - level_);
    return pixels_(x << finer, y << finer) != 0;
  }

  std::size_t level_;  ///< the second finest tells well enough
  Image<std::uint8_t> pixels_;
};

void appendPoint(const RgbdLevel& level, int x, int y, const SurfaceFit& fit,
                 ReferencePoints& points) {
  const LevelCamera& camera = level.camera;
  const Image<GreyDepth>& pixels = level.pixels;
  points.u.push_back((static_cast<float>(x) - camera.cx) / camera.fx);
  points.v.push_back((static_cast<float>(y) - camera.cy) / camera.fy);
  points.q.push_back(fit.q);
  points.q_u.push_back(fit.q_x * camera.fx);
  points.q_v.push_back(fit.q_y * camera.fy);
  points.grey.push_back(pixels(x, y).grey);
  points.grey_u.push_back(0.5F * camera.fx * (pixels(x + 1, y).grey - pixels(x - 1, y).grey));
  points.grey_v.push_back(0.5F * camera.fy * (pixels(x, y + 1).grey - pixels(x, y - 1).grey));
}

void pad(ReferencePoints& points) {
  points.count = points.u.size();
  const std::size_t lanes = ReferencePoints::kLanes;
  const std::size_t padded = (points.count + lanes - 1) / lanes * lanes;
  for (std::vector<float>* array : {&points.u, &points.v, &points.q, &points.grey, &points.grey_u,
                                    &points.grey_v, &points.q_u, &points.q_v}) {
    array->resize(padded, 0.0F);
  }
  points.block.resize(padded, 0);
}

/// What tells which pixels of a level are chosen, and their depth.
struct Choice {
  double textured_share;  ///< of the pixels
  int block_side;         ///< [px]
  const MovedIn& moved_in;
  const PlaneLandmarks* planes;  ///< may be null
};

ReferencePoints choosePoints(const RgbdPyramid& pyramid, std::size_t number, const Choice& choice,
                             const DenseTrackerOptions& options) {
  const RgbdLevel& level = pyramid.levels()[number];
  const Image<GreyDepth>& pixels = level.pixels;
  Image<float> squares = squaredGradients(pixels);
  choice.moved_in.exclude(number, squares);
  const float threshold = gradientThreshold(squares, choice.textured_share, options.min_gradient);
  const int side = std::max(choice.block_side, 1);
  const int blocks_across = (pixels.width() + side - 1) / side;
  ReferencePoints points;
  for (int y = kWindowRadius; y < pixels.height() - kWindowRadius; ++y) {
    for (int x = kWindowRadius; x < pixels.width() - kWindowRadius; ++x) {
      const bool on_grid = x % options.flat_grid_step == 0 && y % options.flat_grid_step == 0;
      if (!(on_grid || squares(x, y) > threshold) || squares(x, y) == kNeverChosen) continue;
      if (!(pixels(x, y).inverse_depth > 0.0F) || isBehindEdge(pixels, x, y)) continue;
      std::optional<SurfaceFit> fit = fitSurface(pixels, x, y);
      if (!fit) continue;
      if (choice.planes != nullptr) snapToPlane(*choice.planes, level.camera, x, y, *fit);
      appendPoint(level, x, y, *fit, points);
      points.block.push_back(static_cast<std::uint16_t>(y / side * blocks_across + x / side));
    }
  }
  points.blocks = blocks_across * ((pixels.height() + side - 1) / side);
  pad(points);
  return points;
}

}  // namespace

TrackingReference::TrackingReference(const RgbdPyramid& pyramid, const DenseTrackerOptions& options,
                                     const std::vector<EarlierImage>& earlier,
                                     const PlaneLandmarks* planes) {
  double share = options.textured_share;
  int block_side = options.information_block;
  const MovedIn moved_in(pyramid, earlier);
  for (std::size_t i = 0; i < pyramid.levels().size(); ++i) {
    const Choice choice{std::min(share, 1.0), block_side, moved_in, planes};
    levels_.push_back(choosePoints(pyramid, i, choice, options));
    share *= 2.0;
    block_side /= 2;
  }
}

}  // namespace planecloud
