// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace planecloud {

/// A read-only window on row-major pixels owned by someone else (a message, an `Image`).
/// Row `y` starts `y * stride()` pixels after the first; `stride() >= width()`.
template <typename Pixel>
class ImageView {
 public:
  ImageView() = default;
  ImageView(const Pixel* pixels, int width, int height, std::ptrdiff_t stride)
      : pixels_(pixels), width_(width), height_(height), stride_(stride) {}
  ImageView(const Pixel* pixels, int width, int height) : ImageView(pixels, width, height, width) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Distance of two rows [pixels].
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] bool empty() const { return width_ == 0 || height_ == 0; }

  /// First pixel of row `y`.
  [[nodiscard]] const Pixel* row(int y) const { return pixels_ + y * stride_; }
  [[nodiscard]] const Pixel& operator()(int x, int y) const { return row(y)[x]; }

 private:
  const Pixel* pixels_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  std::ptrdiff_t stride_ = 0;
};

/// Row-major pixels without gaps between rows.
template <typename Pixel>
class Image {
 public:
  Image() = default;
  Image(int width, int height, Pixel value = Pixel{})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }

  [[nodiscard]] Pixel* row(int y) { return pixels_.data() + std::ptrdiff_t{y} * width_; }
  [[nodiscard]] const Pixel* row(int y) const {
    return pixels_.data() + std::ptrdiff_t{y} * width_;
  }
  [[nodiscard]] Pixel& operator()(int x, int y) { return row(y)[x]; }
  [[nodiscard]] const Pixel& operator()(int x, int y) const { return row(y)[x]; }
  [[nodiscard]] Pixel* begin() { return pixels_.data(); }
  [[nodiscard]] Pixel* end() { return pixels_.data() + pixels_.size(); }
  [[nodiscard]] const Pixel* begin() const { return pixels_.data(); }
  [[nodiscard]] const Pixel* end() const { return pixels_.data() + pixels_.size(); }

  /// Changes the size and keeps the memory when it suffices; the pixels' values are unspecified.
  void resize(int width, int height) {
    width_ = width;
    height_ = height;
    pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }

  [[nodiscard]] ImageView<Pixel> view() const { return {pixels_.data(), width_, height_}; }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace planecloud
