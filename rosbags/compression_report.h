// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "planecloud_slam/rosbags/compression_trial.h"

namespace planecloud {

/// The figures of all frames, kept while the frames themselves are let go.
class CompressionReport {
 public:
  void add(const CompressedFrame& frame);

  [[nodiscard]] std::size_t images() const { return fit_times_.size(); }
  [[nodiscard]] nlohmann::ordered_json json() const;
  /// The same as a table for people.
  [[nodiscard]] std::string table() const;

  /// First line of a table with one line per frame, and the line of a frame.
  [[nodiscard]] static std::string csvHeader();
  [[nodiscard]] static std::string csvLine(const CompressedFrame& frame);

 private:
  /// Of the planes alone.
  [[nodiscard]] double bitsPerPlane() const;
  [[nodiscard]] bool hasTexture() const;

  std::vector<double> fit_times_, encode_times_, decode_times_;  ///< [s]
  std::vector<double> bytes_, texture_bytes_, raw_bytes_, lossless_bytes_, planes_;
  std::vector<double> costlier_;  ///< 1: than the lossless depth
  std::vector<double> coverages_;
  std::vector<double> point_plane_errors_, depth_errors_;  ///< [m]
  std::vector<double> true_errors_, raw_true_errors_;      ///< [m]
};

}  // namespace planecloud
