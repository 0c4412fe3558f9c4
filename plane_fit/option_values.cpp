// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/option_values.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <locale>
#include <numeric>
#include <sstream>
#include <vector>

namespace planecloud {
namespace {

[[noreturn]] void throwNotA(const std::string& what, const std::string& key,
                            const std::string& text) {
  throw std::invalid_argument(key + " = " + text + ": must be " + what);
}

template <typename Number>
void parseNumber(const std::string& what, const std::string& key, const std::string& text,
                 Number& value) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  Number number{};
  if (!(stream >> number) || !(stream >> std::ws).eof()) throwNotA(what, key, text);
  value = number;
}

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

std::string formatOption(bool value) { return value ? "true" : "false"; }

std::string formatOption(int value) { return std::to_string(value); }

std::string formatOption(double value) {
  for (int digits = 6;; ++digits) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream << std::setprecision(digits) << value;
    if (digits >= std::numeric_limits<double>::max_digits10) return stream.str();
    double read = 0.0;
    parseNumber("a number", "", stream.str(), read);
    if (read == value) return stream.str();
  }
}

std::string formatOption(const std::string& value) { return value; }

void parseOption(const std::string& key, const std::string& text, bool& value) {
  if (text != "true" && text != "false") throwNotA("true or false", key, text);
  value = text == "true";
}

void parseOption(const std::string& key, const std::string& text, int& value) {
  parseNumber("a whole number", key, text, value);
}

void parseOption(const std::string& key, const std::string& text, double& value) {
  parseNumber("a number", key, text, value);
}

void parseOption(const std::string&, const std::string& text, std::string& value) { value = text; }

void throwNamingKey(const std::string& key, const std::string& text, const std::string& cause) {
  const std::size_t range = cause.find("must be");
  throw std::invalid_argument(key + " = " + text + ": " +
                              (range == std::string::npos ? cause : cause.substr(range)));
}

std::string nearestKey(const std::string& key, const OptionValues& known) {
  std::string nearest;
  std::size_t nearest_distance = std::numeric_limits<std::size_t>::max();
  for (const auto& [candidate, value] : known) {
    const std::size_t distance = editDistance(key, candidate);
    if (distance >= nearest_distance) continue;
    nearest_distance = distance;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace planecloud
