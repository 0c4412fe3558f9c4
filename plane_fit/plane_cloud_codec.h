// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "planecloud_slam/plane_fit/option_fields.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// Options of `encode`, keys below `codec/`.
struct CodecOptions {
  PlaneCloudEncoding encoding = PlaneCloudEncoding::kCompact;
  /// Step of the inverse depth at a tile's centre [1/m], [1e-4, 0.05], kept to 1e-5 (COMPACT).
  double quantisation_step = 2e-3;
  bool mask = false;    ///< send which pixels of the tiles had depth, exactly (COMPACT)
  int byte_budget = 0;  ///< the stream never exceeds it [B], 0: none, else [64, 2^30]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("encoding", self.encoding);
    visit("quantisation_step", self.quantisation_step);
    visit("mask", self.mask);
    visit("byte_budget", self.byte_budget);
  }
  /// Throws std::invalid_argument that names key, value and range.
  void check() const;
};

/// A stream that is truncated, corrupt, of a foreign version or says the impossible.
class PlaneCloudDecodeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Serialises `cloud`. With a byte budget tiles are merged, and left out where that does not
/// suffice, so that the least distortion is paid for the bytes that are saved: coverage never falls
/// as the budget grows. `statistics` then say `stopped_by_bytes`, what is covered and, estimated,
/// how well.
/// Throws std::invalid_argument for options that fail their check, for tiles that are no nodes of
/// the layout's quadtree, overlap, or have a plane that is not in front of the camera, for a mask
/// that is wished but not there, and for LOSSLESS: that takes `encodeDepth`.
[[nodiscard]] EncodedPlaneCloud encode(const PlaneCloud& cloud, const CodecOptions& options);

/// The exact inverse of `encode` on quantised planes, bit for bit. Never trusts the stream: throws
/// PlaneCloudDecodeError, and allocates no more than the image size implies. From a LOSSLESS stream
/// planes are fitted as the sender would have done.
[[nodiscard]] PlaneCloud decode(const EncodedPlaneCloud& encoded);

/// `cloud` as the receiver of `encode(cloud, options)` will see it (without a byte budget).
[[nodiscard]] PlaneCloud quantise(const PlaneCloud& cloud, const CodecOptions& options);

}  // namespace planecloud
