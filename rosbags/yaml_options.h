// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "planecloud_slam/plane_fit/option_values.h"

namespace planecloud {

/// Reads a YAML file into options by key: nested maps become `outer/inner`. Throws
/// std::runtime_error naming file and line for what is not YAML, a list or a repeated key.
[[nodiscard]] OptionValues readYamlOptions(const std::string& path);

/// The same values as nested YAML maps, keys sorted.
[[nodiscard]] std::string formatYamlOptions(const OptionValues& values);

/// Throws std::invalid_argument naming the first of `unknown` and the nearest of `known`; does
/// nothing when `unknown` is empty.
void refuseUnknownOptions(const OptionValues& unknown, const OptionValues& known);

/// Reads `path` into `options`, whose other fields keep their values, and checks them. Throws
/// std::runtime_error or std::invalid_argument naming the file, the key and what is wrong.
template <typename Options>
void loadYamlOptions(const std::string& path, Options& options) {
  OptionValues values = readYamlOptions(path);
  const OptionValues known = dumpOptions(options);
  try {
    takeOptions(values, options);
    refuseUnknownOptions(values, known);
    options.check();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("'" + path + "': " + error.what());
  }
}

}  // namespace planecloud
