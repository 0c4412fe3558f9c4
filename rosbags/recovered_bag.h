// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace planecloud {

/// A whole copy, in a temporary file, of what can be read of a bag without index: one whose
/// recorder was killed or that was cut in mid-message. The copy is removed with the object.
class RecoveredBag {
 public:
  /// Whether the file exists and starts like a bag of format 2.0.
  [[nodiscard]] static bool isBag(const std::string& path);
  /// Copies message by message up to the first that is not complete. Throws std::runtime_error when
  /// `path` is no bag of format 2.0 or the copy cannot be written.
  explicit RecoveredBag(const std::string& path);
  ~RecoveredBag();
  RecoveredBag(const RecoveredBag&) = delete;
  RecoveredBag& operator=(const RecoveredBag&) = delete;

  /// The copy.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Messages in it.
  [[nodiscard]] std::size_t messages() const { return messages_; }

 private:
  std::string path_;
  std::size_t messages_ = 0;
};

}  // namespace planecloud
