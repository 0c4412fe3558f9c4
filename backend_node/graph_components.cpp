// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/graph_components.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace planecloud {
namespace {

std::size_t position(int number) { return static_cast<std::size_t>(number); }

}  // namespace

void GraphComponents::add() {
  of_.push_back(count());
  members_.push_back({static_cast<int>(of_.size()) - 1});
}

void GraphComponents::join(int node, int other) {
  const auto [older, younger] = std::minmax({of(node), of(other)});
  if (older == younger) return;
  std::vector<int>& members = members_[position(older)];
  const std::vector<int> joining = std::move(members_[position(younger)]);
  const auto middle = static_cast<std::ptrdiff_t>(members.size());
  members.insert(members.end(), joining.begin(), joining.end());
  std::inplace_merge(members.begin(), members.begin() + middle, members.end());
  for (const int member : joining) of_[position(member)] = older;
  members_.erase(members_.begin() + younger);
  for (int later = younger; later < count(); ++later) {
    for (const int member : members_[position(later)]) of_[position(member)] = later;
  }
}

void GraphComponents::assign(const std::vector<int>& labels) {
  of_.clear();
  members_.clear();
  std::map<int, int> numbers;
  for (const int label : labels) {
    const auto [number, is_new] = numbers.emplace(label, count());
    if (is_new) members_.emplace_back();
    members_[position(number->second)].push_back(static_cast<int>(of_.size()));
    of_.push_back(number->second);
  }
}

}  // namespace planecloud
