// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <utility>

namespace planecloud {
namespace {

constexpr std::size_t kWidth = 40;  // characters

}  // namespace

ProgressBar::ProgressBar(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), visible_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (visible_ && done_ > 0) std::cerr << '\n';
}

void ProgressBar::advance() {
  ++done_;
  if (!visible_) return;
  const std::size_t step = std::max<std::size_t>(total_ / 200, 1);
  if (done_ % step == 0 || done_ == total_) draw();
}

void ProgressBar::print(const std::string& line) const {
  if (visible_) std::cerr << "\r\033[K";  // clears the bar's line
  std::cerr << line << '\n';
  if (visible_ && done_ > 0) draw();
}

void ProgressBar::draw() const {
  std::cerr << '\r' << label_ << ' ';
  if (total_ > 0) {
    const std::size_t filled = std::min(kWidth, kWidth * done_ / total_);
    std::cerr << '[' << std::string(filled, '#') << std::string(kWidth - filled, ' ') << "] ";
    std::cerr << done_ << '/' << total_;
  } else {
    std::cerr << done_;
  }
  std::cerr << std::flush;
}

}  // namespace planecloud
