// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "planecloud_slam/backend_node/edge_list.h"
#include "planecloud_slam/backend_node/relative_pose_cost.h"

namespace planecloud {
namespace {

GraphEdge numbered(std::uint32_t number) {
  GraphEdge edge;
  edge.from = {"a", 1, number};
  return edge;
}

std::vector<std::uint32_t> numbers(const EdgeList& list) {
  std::vector<std::uint32_t> result;
  for (const GraphEdge& edge : list) result.push_back(edge.from.number);
  return result;
}

TEST(EdgeList, DoesWhatAVectorDoes) {
  EdgeList list;
  std::vector<std::uint32_t> expected;
  std::mt19937 random(1);
  for (std::uint32_t i = 0; i < 2000; ++i) {
    // Grows to some hundred edges, then shrinks to none: all borders of blocks are crossed.
    const bool add = expected.empty() || random() % 10 < (i < 1000 ? 7U : 3U);
    if (add) {
      list.push_back(numbered(i));
      expected.push_back(i);
    } else {
      const std::size_t place = random() % expected.size();
      list.remove(place);
      expected[place] = expected.back();
      expected.pop_back();
    }
    ASSERT_EQ(list.size(), expected.size());
    ASSERT_EQ(list.empty(), expected.empty());
  }
  EXPECT_EQ(numbers(list), expected);
}

TEST(EdgeList, ACopyStaysWhatItWas) {
  EdgeList list;
  for (std::uint32_t i = 0; i < 150; ++i) list.push_back(numbered(i));
  const EdgeList copy = list;
  const std::vector<std::uint32_t> before = numbers(copy);
  list.remove(3);
  list.push_back(numbered(200));
  while (!list.empty()) list.remove(0);
  EXPECT_EQ(numbers(copy), before);
}

TEST(EdgeList, GivesBackWhatItGot) {
  GraphEdge edge;
  edge.kind = EdgeKind::kClosure;
  edge.from = {"a", 17, 3};
  edge.to = {"a robot with a long name", 1700000000123456789U, 42};
  Vector6d xi;
  xi << 1.2, -20.1, 0.3, 0.4, -1.7, 2.1;
  edge.T_from_to = expSe3(xi);
  edge.information = xi * xi.transpose();  // all but one direction unobserved
  edge.inter_robot = true;
  EdgeList list;
  list.push_back(GraphEdge());
  list.push_back(edge);
  const GraphEdge back = list[1];
  EXPECT_EQ(list.kind(1), EdgeKind::kClosure);
  EXPECT_EQ(back.kind, edge.kind);
  EXPECT_EQ(back.from, edge.from);
  EXPECT_EQ(back.to, edge.to);
  EXPECT_EQ(back.inter_robot, edge.inter_robot);
  EXPECT_TRUE(back.T_from_to.isApprox(edge.T_from_to, 1e-15));
  EXPECT_TRUE(back.information.isApprox(edge.information, 1e-6)) << "single precision";
}

TEST(EdgeList, LeavesUnobservedWhatIsUnobserved) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  for (int trial = 0; trial < 20; ++trial) {
    Matrix6d roots;
    for (int i = 0; i < 36; ++i) roots(i) = 100.0 * gauss(random);
    Vector6d unobserved;
    for (int i = 0; i < 6; ++i) unobserved(i) = gauss(random);
    unobserved.normalize();
    roots -= roots * unobserved * unobserved.transpose();
    GraphEdge edge;
    edge.information = roots.transpose() * roots;
    EdgeList list;
    list.push_back(edge);
    const GraphEdge back = list[0];
    EXPECT_TRUE(back.information.isApprox(edge.information, 1e-6));
    EXPECT_EQ(back.information, back.information.transpose());
    // A float of the matrix itself would claim to know this direction to some 30 m.
    EXPECT_LT(unobserved.dot(back.information * unobserved), 1e-6) << "[1/m^2]";
    EXPECT_LT((squareRootInformation(back.information) * unobserved).norm(), 1e-2);
  }
}

}  // namespace
}  // namespace planecloud
