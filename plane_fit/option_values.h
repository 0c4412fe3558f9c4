// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <type_traits>

#include "planecloud_slam/plane_fit/option_fields.h"

/// Options as text by key, `plane_fit/tolerance` -> `0.01`: the form between the structs and
/// wherever the values come from (ROS parameters, YAML files, dumps).
namespace planecloud {

using OptionValues = std::map<std::string, std::string>;

/// The text that `parseOption` reads back to the same value.
[[nodiscard]] std::string formatOption(bool value);
[[nodiscard]] std::string formatOption(int value);
[[nodiscard]] std::string formatOption(double value);
[[nodiscard]] std::string formatOption(const std::string& value);

/// Sets `value` from `text`. Each throws std::invalid_argument `key = text: must be a ...`.
void parseOption(const std::string& key, const std::string& text, bool& value);
void parseOption(const std::string& key, const std::string& text, int& value);
void parseOption(const std::string& key, const std::string& text, double& value);
void parseOption(const std::string& key, const std::string& text, std::string& value);

/// Throws std::invalid_argument `key = text: must be ...` from the end of `cause`.
[[noreturn]] void throwNamingKey(const std::string& key, const std::string& text,
                                 const std::string& cause);

/// The values of all fields of `options`, keys after `prefix`.
template <typename Options>
[[nodiscard]] OptionValues dumpOptions(const Options& options, const std::string& prefix = "") {
  OptionValues values;
  visitFields(prefix, options, [&](const std::string& key, const auto& field) {
    if constexpr (std::is_enum_v<std::decay_t<decltype(field)>>) {
      values[key] = toString(field);
    } else {
      values[key] = formatOption(field);
    }
  });
  return values;
}

/// Sets those fields of `options` that `values` has a text for and removes them from `values`;
/// what remains there is unknown to these options. Ranges are left to `options.check()`.
/// Throws std::invalid_argument naming the key when a text does not fit its field.
template <typename Options>
void takeOptions(OptionValues& values, Options& options, const std::string& prefix = "") {
  visitFields(prefix, options, [&](const std::string& key, auto& field) {
    const auto found = values.find(key);
    if (found == values.end()) return;
    if constexpr (std::is_enum_v<std::decay_t<decltype(field)>>) {
      try {
        fromString(found->second, field);
      } catch (const std::invalid_argument& error) {
        throwNamingKey(key, found->second, error.what());
      }
    } else {
      parseOption(key, found->second, field);
    }
    values.erase(found);
  });
}

/// The key of `known` nearest to `key` in edit distance: what was meant by a misspelt one.
/// Empty when `known` is.
[[nodiscard]] std::string nearestKey(const std::string& key, const OptionValues& known);

}  // namespace planecloud
