// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/edge_list.h"

#include <utility>

namespace planecloud {

const GraphEdge& EdgeList::operator[](std::size_t position) const {
  const std::size_t block = position / kBlock;
  return block < blocks_.size() ? (*blocks_[block])[position % kBlock] : tail_[position % kBlock];
}

void EdgeList::push_back(const GraphEdge& edge) {
  tail_.push_back(edge);
  if (tail_.size() < kBlock) return;
  blocks_.push_back(std::make_shared<const Block>(std::move(tail_)));
  tail_ = {};
}

void EdgeList::popBack() {
  if (tail_.empty()) {
    tail_ = *blocks_.back();
    blocks_.pop_back();
  }
  tail_.pop_back();
}

void EdgeList::remove(std::size_t position) {
  const GraphEdge last = (*this)[size() - 1];
  popBack();
  if (position == size()) return;
  const std::size_t block = position / kBlock;
  if (block == blocks_.size()) {
    tail_[position % kBlock] = last;
    return;
  }
  auto changed = std::make_shared<Block>(*blocks_[block]);
  (*changed)[position % kBlock] = last;
  blocks_[block] = std::move(changed);
}

}  // namespace planecloud
