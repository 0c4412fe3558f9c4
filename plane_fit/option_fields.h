// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

/// Options are structs with a static `fields(self, visit)` that calls `visit(name, member)` for
/// every member, so that ROS parameters, YAML files, dumps and tests share one list of names.
///
///     struct PlaneFitOptions {
///       double tolerance = 0.01;  ///< [m], (0, 1]
///       template <typename Self, typename Visit>
///       static void fields(Self& self, Visit&& visit) { visit("tolerance", self.tolerance); }
///       void check() const { checkRange("plane_fit/tolerance", tolerance, 1e-4, 1.0); }
///     };
///
/// Members are bool, int, double, std::string, or an enum with
/// `std::string toString(E)` and `void fromString(const std::string&, E&)` (throws
/// std::invalid_argument naming the choices) found by argument-dependent lookup.
namespace planecloud {

/// Visits the fields of `options` with `prefix` before each name: `"plane_fit/" + name`.
template <typename Options, typename Visit>
void visitFields(const std::string& prefix, Options& options, Visit&& visit) {
  std::remove_const_t<Options>::fields(
      options, [&](const std::string& name, auto& field) { visit(prefix + name, field); });
}

/// Throws std::invalid_argument `key = value: must be in [low, high]` when out of range or NaN.
template <typename Number>
void checkRange(const std::string& key, Number value, Number low, Number high) {
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << key << " = " << value << ": must be in [" << low << ", " << high << "]";
  throw std::invalid_argument(text.str());
}

}  // namespace planecloud
