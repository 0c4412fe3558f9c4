// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace planecloud {

/// One line on stderr that shows how far a tool has come; silent unless stderr is a terminal.
class ProgressBar {
 public:
  /// `total` 0: unknown, only the count is shown.
  ProgressBar(std::string label, std::size_t total);
  /// Ends the line.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void advance();
  /// A line of text on stderr, above the bar; also when there is no terminal.
  void print(const std::string& line) const;

 private:
  void draw() const;

  const std::string label_;
  const std::size_t total_;
  const bool visible_;
  std::size_t done_ = 0;
};

}  // namespace planecloud
