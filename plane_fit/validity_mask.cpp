// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/validity_mask.h"

#include <algorithm>
#include <array>

#include "planecloud_slam/plane_fit/depth_traits.h"

namespace planecloud {
namespace {

constexpr int kBlock = 8;
constexpr int kMargin = 2;  // pixels beyond the border that contexts look at

enum Pixel : std::uint8_t { kInvalid, kValid, kUnknown };
enum Block : std::uint8_t { kNoTile, kFull, kEmpty, kMixed };

/// One routine for both directions: `Coder` is a `RangeEncoder` or a `RangeDecoder`.
template <typename Coder>
class MaskCoder {
 public:
  /// Keeps a reference to `mask`, the truth when encoding.
  MaskCoder(Coder& coder, const Image<std::uint8_t>& mask, const std::vector<TileRect>& tiles)
      : coder_(coder),
        mask_(mask),
        pixels_(mask.width() + 2 * kMargin, mask.height() + 2 * kMargin, kInvalid),
        blocks_((mask.width() + kBlock - 1) / kBlock + 1, (mask.height() + kBlock - 1) / kBlock + 1,
                kNoTile) {
    for (const TileRect& tile : tiles) {
      for (int y = tile.y; y < tile.y + tile.height; ++y) {
        std::fill_n(&at(tile.x, y), tile.width, kUnknown);
      }
    }
  }

  void code() {
    const auto for_each_block = [this](auto&& visit) {
      for (int y = 0; y < mask_.height(); y += kBlock) {
        for (int x = 0; x < mask_.width(); x += kBlock) visit(x, y);
      }
    };
    for_each_block([this](int x, int y) { codeBlock(x, y); });
    for_each_block([this](int x, int y) {
      if (block(x, y) == kMixed) codePixels(x, y);
    });
  }

  /// 1 where a pixel of a tile has depth.
  [[nodiscard]] Image<std::uint8_t> result() const {
    Image<std::uint8_t> mask(mask_.width(), mask_.height(), 0);
    for (int y = 0; y < mask.height(); ++y) {
      std::copy_n(pixels_.row(y + kMargin) + kMargin, mask.width(), mask.row(y));
    }
    return mask;
  }

 private:
  std::uint8_t& at(int x, int y) { return pixels_(x + kMargin, y + kMargin); }
  /// The block of a pixel; column and row 0 of `blocks_` lie beyond the border.
  std::uint8_t& block(int x, int y) { return blocks_(x / kBlock + 1, y / kBlock + 1); }

  template <typename Visit>
  void forPixels(int x0, int y0, Visit&& visit) {
    for (int y = y0; y < std::min(y0 + kBlock, mask_.height()); ++y) {
      for (int x = x0; x < std::min(x0 + kBlock, mask_.width()); ++x) visit(x, y);
    }
  }

  void codeBlock(int x0, int y0) {
    bool tiled = false, any = false, all = true;
    forPixels(x0, y0, [&](int x, int y) {
      if (at(x, y) != kUnknown) return;
      tiled = true;
      any = any || mask_(x, y) != 0;
      all = all && mask_(x, y) != 0;
    });
    if (!tiled) return;
    const std::uint8_t left = blocks_(x0 / kBlock, y0 / kBlock + 1);
    const std::uint8_t above = blocks_(x0 / kBlock + 1, y0 / kBlock);
    const auto context = static_cast<std::size_t>(4 * left + above);
    std::uint8_t& result = block(x0, y0);
    result = kMixed;
    if (coder_.code(all, full_[context])) {
      result = kFull;
    } else if (coder_.code(!any, empty_[context])) {
      result = kEmpty;
    }
    if (result == kMixed) return;
    forPixels(x0, y0, [&](int x, int y) {
      if (at(x, y) == kUnknown) at(x, y) = result == kFull ? kValid : kInvalid;
    });
  }

  void codePixels(int x0, int y0) {
    forPixels(x0, y0, [this](int x, int y) {
      if (at(x, y) != kUnknown) return;
      const bool valid = coder_.code(mask_(x, y) != 0, pixel_[context(x, y)]);
      at(x, y) = valid ? kValid : kInvalid;
    });
  }

  std::size_t context(int x, int y) {
    const auto valid = [&](int dx, int dy, unsigned bit) {
      return at(x + dx, y + dy) == kValid ? bit : 0U;
    };
    const unsigned before = valid(-1, 0, 1) | valid(0, -1, 2) | valid(-1, -1, 4) | valid(1, -1, 8) |
                            valid(-2, 0, 16) | valid(0, -2, 32);
    return (std::size_t{before} * 3 + at(x + 1, y)) * 3 + at(x, y + 1);
  }

  Coder& coder_;
  const Image<std::uint8_t>& mask_;
  Image<std::uint8_t> pixels_;  // what is known so far
  Image<std::uint8_t> blocks_;
  std::array<AdaptiveBit, 16> full_;
  std::array<AdaptiveBit, 16> empty_;
  std::array<AdaptiveBit, 64 * 9> pixel_;
};

}  // namespace

Image<std::uint8_t> validityMask(ImageView<float> depth) {
  Image<std::uint8_t> mask(depth.width(), depth.height());
  for (int y = 0; y < depth.height(); ++y) {
    std::transform(depth.row(y), depth.row(y) + depth.width(), mask.row(y),
                   [](float z) { return static_cast<std::uint8_t>(hasDepth(z) ? 1 : 0); });
  }
  return mask;
}

void encodeMask(RangeEncoder& coder, const Image<std::uint8_t>& mask,
                const std::vector<TileRect>& tiles) {
  MaskCoder<RangeEncoder>(coder, mask, tiles).code();
}

Image<std::uint8_t> decodeMask(RangeDecoder& coder, const CameraIntrinsics& camera,
                               const std::vector<TileRect>& tiles) {
  const Image<std::uint8_t> nothing(camera.width, camera.height, 0);
  MaskCoder<RangeDecoder> mask(coder, nothing, tiles);
  mask.code();
  return mask.result();
}

}  // namespace planecloud
