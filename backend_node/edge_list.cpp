// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/edge_list.h"

#include <algorithm>
#include <utility>

namespace planecloud {

const EdgeList::Packed& EdgeList::packed(std::size_t position) const {
  const std::size_t block = position / kBlock;
  return block < blocks_.size() ? (*blocks_[block])[position % kBlock] : tail_[position % kBlock];
}

EdgeList::End EdgeList::pack(const KeyframeId& id) {
  const auto known = std::find(robots_.begin(), robots_.end(), id.robot);
  const auto robot = static_cast<std::uint32_t>(known - robots_.begin());
  if (known == robots_.end()) robots_.push_back(id.robot);
  return {id.session, id.number, robot};
}

KeyframeId EdgeList::unpack(const End& end) const {
  return {robots_[end.robot], end.session, end.number};
}

GraphEdge EdgeList::operator[](std::size_t position) const {
  const Packed& edge = packed(position);
  GraphEdge result;
  result.kind = edge.kind;
  result.from = unpack(edge.from);
  result.to = unpack(edge.to);
  result.inter_robot = edge.inter_robot;
  result.T_from_to.translation() = Eigen::Map<const Eigen::Vector3d>(edge.translation.data());
  result.T_from_to.linear() =
      Eigen::Map<const Eigen::Quaterniond>(edge.rotation.data()).toRotationMatrix();
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      result.information(row, column) = edge.information[next];
      result.information(column, row) = edge.information[next++];
    }
  }
  return result;
}

void EdgeList::push_back(const GraphEdge& edge) {
  Packed result;
  result.kind = edge.kind;
  result.from = pack(edge.from);
  result.to = pack(edge.to);
  result.inter_robot = edge.inter_robot;
  Eigen::Map<Eigen::Vector3d>(result.translation.data()) = edge.T_from_to.translation();
  Eigen::Map<Eigen::Quaterniond>(result.rotation.data()) =
      Eigen::Quaterniond(edge.T_from_to.linear()).normalized();
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      result.information[next++] =
          0.5 * (edge.information(row, column) + edge.information(column, row));
    }
  }
  append(result);
}

void EdgeList::append(const Packed& edge) {
  if (tail_.capacity() == 0) tail_.reserve(kBlock);
  tail_.push_back(edge);
  if (tail_.size() < kBlock) return;
  blocks_.push_back(std::make_shared<const Block>(std::move(tail_)));
  tail_ = Block();
}

void EdgeList::popBack() {
  if (tail_.empty()) {
    tail_ = *blocks_.back();
    blocks_.pop_back();
  }
  tail_.pop_back();
}

void EdgeList::remove(std::size_t position) {
  const Packed last = packed(size() - 1);
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
