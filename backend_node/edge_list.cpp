// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/edge_list.h"

#include <Eigen/QR>
#include <algorithm>
#include <utility>

#include "planecloud_slam/backend_node/relative_pose_cost.h"

namespace planecloud {

const EdgeList::Packed& EdgeList::packed(std::size_t position) const {
  const std::size_t block = position / kBlock;
  return block < blocks_.size() ? (*blocks_[block])[position % kBlock] : tail_[position % kBlock];
}

EdgeList::End EdgeList::pack(const KeyframeId& id) {
  const auto known = std::find_if(sessions_.begin(), sessions_.end(), [&](const Session& session) {
    return session.number == id.session && session.robot == id.robot;
  });
  const auto position = static_cast<std::uint32_t>(known - sessions_.begin());
  if (known == sessions_.end()) sessions_.push_back({id.robot, id.session});
  return {position, id.number};
}

KeyframeId EdgeList::unpack(const End& end) const {
  const Session& session = sessions_[end.session];
  return {session.robot, session.number, end.number};
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
  Matrix6d root = Matrix6d::Zero();
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) root(row, column) = edge.root_information[next++];
  }
  const Matrix6d information = root.transpose() * root;
  result.information = 0.5 * (information + information.transpose());
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
  const Matrix6d information = 0.5 * (edge.information + edge.information.transpose());
  const Matrix6d root =
      Eigen::HouseholderQR<Matrix6d>(squareRootInformation(information)).matrixQR();
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      result.root_information[next++] = static_cast<float>(root(row, column));
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
