// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/alignment_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace planecloud {
namespace {

constexpr std::size_t kLanes = ReferencePoints::kLanes;
using Lanes = Eigen::Array<float, kLanes, 1>;
using LanesMap = Eigen::Map<const Lanes>;

constexpr float kAgreeing = 0.05F;    ///< relative inverse depth
constexpr float kNotOccluded = 0.2F;  ///< relative inverse depth
constexpr float kCellSpread = 0.1F;   ///< relative inverse depth within 2x2 pixels
constexpr float kMiddleGrey = 128.0F;
constexpr float kInverseGreySpread = 1.0F / 64.0F;
/// Partial sums of this many points are kept in float.
constexpr std::size_t kChunk = 256 * kLanes;

void project(const ReferencePoints& points, const LevelCamera& camera,
             const Eigen::Isometry3d& T_current_reference, Residuals& out) {
  const Eigen::Matrix3f R = T_current_reference.linear().cast<float>();
  const Eigen::Vector3f t = T_current_reference.translation().cast<float>();
  for (std::size_t i = 0; i < points.paddedCount(); i += kLanes) {
    const Lanes u = LanesMap(points.u.data() + i);
    const Lanes v = LanesMap(points.v.data() + i);
    const Lanes q = LanesMap(points.q.data() + i);
    const Lanes x = R(0, 0) * u + R(0, 1) * v + (R(0, 2) + t(0) * q);
    const Lanes y = R(1, 0) * u + R(1, 1) * v + (R(1, 2) + t(1) * q);
    const Lanes z = R(2, 0) * u + R(2, 1) * v + (R(2, 2) + t(2) * q);
    const Lanes inverse_z = 1.0F / z;
    Eigen::Map<Lanes>(out.x.data() + i) = camera.fx * (x * inverse_z) + camera.cx;
    Eigen::Map<Lanes>(out.y.data() + i) = camera.fy * (y * inverse_z) + camera.cy;
    Eigen::Map<Lanes>(out.predicted_q.data() + i) = q * inverse_z;
  }
}

float interpolate(float a, float b, float c, float d, float fx, float fy) {
  const float upper = a + fx * (b - a);
  const float lower = c + fx * (d - c);
  return upper + fy * (lower - upper);
}

/// Inverse depth between four pixels: linear within one surface (exact on a plane), else that of
/// the nearest pixel; 0 when there is none.
float sampleInverseDepth(const GreyDepth* upper, const GreyDepth* lower, float fx, float fy) {
  const float a = upper[0].inverse_depth;
  const float b = upper[1].inverse_depth;
  const float c = lower[0].inverse_depth;
  const float d = lower[1].inverse_depth;
  const float low = std::min(std::min(a, b), std::min(c, d));
  const float high = std::max(std::max(a, b), std::max(c, d));
  if (low > (1.0F - kCellSpread) * high) return interpolate(a, b, c, d, fx, fy);
  const GreyDepth* row = fy < 0.5F ? upper : lower;
  return row[fx < 0.5F ? 0 : 1].inverse_depth;
}

/// Eight points' whitened residuals and Jacobian rows.
struct WhitenedLanes {
  std::array<Lanes, 6> row1;  ///< of e1, over the twist
  std::array<Lanes, 6> row2;  ///< of e2, over the twist
  Lanes brightness;           ///< of e1, over the gain unknown
  Lanes e1;
  Lanes e2;
  Lanes weight;
};

struct Whitening {
  float inverse_grey;
  float inverse_q;
  float slope;
  float nu;
};

Whitening makeWhitening(const ResidualScale& scale, double nu) {
  return {static_cast<float>(1.0 / scale.sigma_grey), static_cast<float>(1.0 / scale.sigma_q),
          static_cast<float>(scale.slope), static_cast<float>(nu)};
}

inline WhitenedLanes whiten(const ReferencePoints& points, const ResidualView& residuals,
                            const Whitening& whitening, std::size_t i) {
  const Lanes u = LanesMap(points.u.data() + i);
  const Lanes v = LanesMap(points.v.data() + i);
  const Lanes q = LanesMap(points.q.data() + i);
  const Lanes r_q = LanesMap(residuals.q + i);
  WhitenedLanes w;
  w.e1 = (LanesMap(residuals.grey + i) - whitening.slope * r_q) * whitening.inverse_grey;
  w.e2 = r_q * whitening.inverse_q;
  w.weight = LanesMap(residuals.seen + i) * (whitening.nu + 2.0F) /
             (whitening.nu + w.e1 * w.e1 + w.e2 * w.e2);
  w.brightness = (LanesMap(points.grey.data() + i) - kMiddleGrey) *
                 (kInverseGreySpread * whitening.inverse_grey);

  // A motion dp of the point changes the residuals by q g . dp: for inverse depth g is its plane
  // (alpha, beta, gamma), for grey its gradient, which does not change along the ray. Whitened,
  // grey minus slope times inverse depth.
  const Lanes b1 = LanesMap(points.q_u.data() + i) * whitening.inverse_q;
  const Lanes b2 = LanesMap(points.q_v.data() + i) * whitening.inverse_q;
  const Lanes b3 = q * whitening.inverse_q - b1 * u - b2 * v;
  const float slope = whitening.slope * whitening.inverse_grey;
  const Lanes i1 = LanesMap(points.grey_u.data() + i) * whitening.inverse_grey;
  const Lanes i2 = LanesMap(points.grey_v.data() + i) * whitening.inverse_grey;
  const float to_q = slope / whitening.inverse_q;
  const Lanes a1 = i1 - to_q * b1;
  const Lanes a2 = i2 - to_q * b2;
  const Lanes a3 = -(i1 * u + i2 * v) - to_q * b3;
  // With dp = rho + phi x p and p = (u, v, 1) / q.
  w.row1 = {q * a1, q * a2, q * a3, v * a3 - a2, a1 - u * a3, u * a2 - v * a1};
  w.row2 = {q * b1, q * b2, q * b3, v * b3 - b2, b1 - u * b3, u * b2 - v * b1};
  return w;
}

/// Sums of the normal equations in float lanes: 21 + 6 over the twist, 17 with brightness.
struct LaneSums {
  std::array<Lanes, 21> twist_twist;
  std::array<Lanes, 6> twist_error;
  std::array<Lanes, 6> twist_offset;
  std::array<Lanes, 6> twist_gain;
  Lanes offset_offset, offset_gain, gain_gain, offset_error, gain_error, error;

  LaneSums() { clear(); }
  void clear() {
    for (Lanes& sum : twist_twist) sum.setZero();
    for (int k = 0; k < 6; ++k) {
      twist_error[k].setZero();
      twist_offset[k].setZero();
      twist_gain[k].setZero();
    }
    for (Lanes* sum :
         {&offset_offset, &offset_gain, &gain_gain, &offset_error, &gain_error, &error}) {
      sum->setZero();
    }
  }
};

inline void add(const WhitenedLanes& w, float inverse_grey, LaneSums& sums) {
  const Lanes weighted_e1 = w.weight * w.e1;
  const Lanes weighted_e2 = w.weight * w.e2;
  const Lanes weighted_offset = w.weight * inverse_grey;
  const Lanes weighted_gain = w.weight * w.brightness;
  std::size_t k = 0;
  for (std::size_t row = 0; row < 6; ++row) {
    const Lanes weighted1 = w.weight * w.row1[row];
    const Lanes weighted2 = w.weight * w.row2[row];
    for (std::size_t column = row; column < 6; ++column, ++k) {
      sums.twist_twist[k] += weighted1 * w.row1[column] + weighted2 * w.row2[column];
    }
    sums.twist_error[row] += weighted_e1 * w.row1[row] + weighted_e2 * w.row2[row];
    sums.twist_offset[row] += weighted_offset * w.row1[row];
    sums.twist_gain[row] += weighted_gain * w.row1[row];
  }
  sums.offset_offset += weighted_offset * inverse_grey;
  sums.offset_gain += weighted_offset * w.brightness;
  sums.gain_gain += weighted_gain * w.brightness;
  sums.offset_error += weighted_e1 * inverse_grey;
  sums.gain_error += weighted_e1 * w.brightness;
  sums.error += weighted_e1 * w.e1 + weighted_e2 * w.e2;
}

double total(const Lanes& lanes) { return lanes.cast<double>().sum(); }

void flush(LaneSums& sums, NormalEquations& equations) {
  std::size_t k = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column, ++k) {
      equations.matrix(row, column) += total(sums.twist_twist[k]);
    }
    const auto r = static_cast<std::size_t>(row);
    equations.vector(row) += total(sums.twist_error[r]);
    equations.matrix(row, 6) += total(sums.twist_offset[r]);
    equations.matrix(row, 7) += total(sums.twist_gain[r]);
  }
  equations.matrix(6, 6) += total(sums.offset_offset);
  equations.matrix(6, 7) += total(sums.offset_gain);
  equations.matrix(7, 7) += total(sums.gain_gain);
  equations.vector(6) += total(sums.offset_error);
  equations.vector(7) += total(sums.gain_error);
  equations.error += total(sums.error);
  sums.clear();
}

}  // namespace

void computeResiduals(const ReferencePoints& points, const RgbdLevel& current,
                      const Eigen::Isometry3d& T_current_reference, const Brightness& brightness,
                      Residuals& out) {
  for (std::vector<float>* array :
       {&out.x, &out.y, &out.predicted_q, &out.grey, &out.q, &out.seen}) {
    array->resize(points.paddedCount());
  }
  out.in_image = out.agreeing = out.seen_count = 0;
  project(points, current.camera, T_current_reference, out);
  const auto right = static_cast<float>(current.camera.width - 1);
  const auto bottom = static_cast<float>(current.camera.height - 1);
  const auto inverse_gain = static_cast<float>(1.0 / brightness.gain);
  const auto offset = static_cast<float>(brightness.offset);
  for (std::size_t i = 0; i < points.paddedCount(); ++i) {
    const float x = out.x[i];
    const float y = out.y[i];
    const float predicted = out.predicted_q[i];
    out.grey[i] = out.q[i] = out.seen[i] = 0.0F;
    if (!(x >= 0.0F && x < right && y >= 0.0F && y < bottom && predicted > 0.0F)) continue;
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const float fx = x - static_cast<float>(column);
    const float fy = y - static_cast<float>(row);
    const GreyDepth* upper = current.pixels.row(row) + column;
    const GreyDepth* lower = upper + current.camera.width;
    const float q = sampleInverseDepth(upper, lower, fx, fy);
    if (!(q > 0.0F)) continue;
    const float r_q = q - predicted;
    const float deviation = std::abs(r_q);
    ++out.in_image;
    out.agreeing += deviation < kAgreeing * predicted ? 1 : 0;
    if (deviation > kNotOccluded * predicted) continue;
    const float grey =
        interpolate(upper[0].grey, upper[1].grey, lower[0].grey, lower[1].grey, fx, fy);
    out.grey[i] = (grey - offset) * inverse_gain - points.grey[i];
    out.q[i] = r_q;
    out.seen[i] = 1.0F;
    ++out.seen_count;
  }
}

NormalEquations accumulateNormalEquations(const ReferencePoints& points,
                                          const ResidualView& residuals, const ResidualScale& scale,
                                          double nu) {
  const Whitening whitening = makeWhitening(scale, nu);
  NormalEquations equations;
  LaneSums sums;
  for (std::size_t begin = 0; begin < residuals.count; begin += kChunk) {
    const std::size_t end = std::min(begin + kChunk, residuals.count);
    for (std::size_t i = begin; i < end; i += kLanes) {
      add(whiten(points, residuals, whitening, i), whitening.inverse_grey, sums);
    }
    flush(sums, equations);
  }
  equations.matrix.triangularView<Eigen::StrictlyLower>() = equations.matrix.transpose();
  return equations;
}

BlockScatter accumulateBlockScatter(const ReferencePoints& points, const ResidualView& residuals,
                                    const ResidualScale& scale, double nu) {
  const Whitening whitening = makeWhitening(scale, nu);
  const auto blocks = static_cast<std::size_t>(points.blocks);
  std::vector<Eigen::Matrix<float, kUnknowns, 1>> gradients(
      blocks, Eigen::Matrix<float, kUnknowns, 1>::Zero());
  for (std::size_t i = 0; i < residuals.count; i += kLanes) {
    const WhitenedLanes w = whiten(points, residuals, whitening, i);
    const Lanes e1 = w.weight * w.e1;
    const Lanes e2 = w.weight * w.e2;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto l = static_cast<Eigen::Index>(lane);
      Eigen::Matrix<float, kUnknowns, 1>& gradient = gradients[points.block[i + lane]];
      for (int k = 0; k < 6; ++k) {
        const auto row = static_cast<std::size_t>(k);
        gradient(k) += e1(l) * w.row1[row](l) + e2(l) * w.row2[row](l);
      }
      gradient(6) += e1(l) * whitening.inverse_grey;
      gradient(7) += e1(l) * w.brightness(l);
    }
  }
  BlockScatter scatter;
  for (const Eigen::Matrix<float, kUnknowns, 1>& gradient : gradients) {
    if (gradient.isZero(0.0F)) continue;
    const StepVector g = gradient.cast<double>();
    scatter.matrix += g * g.transpose();
    ++scatter.blocks;
  }
  return scatter;
}

}  // namespace planecloud
