// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace planecloud {

/// A received message that is truncated, inconsistent or says the impossible. The text names the
/// field, its value and, where there is one, the cure.
class MessageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

[[noreturn]] inline void refuseMessage(const std::string& reason) { throw MessageError(reason); }

}  // namespace planecloud
