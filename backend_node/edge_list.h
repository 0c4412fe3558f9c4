// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>
#include <vector>

#include "planecloud_slam/backend_node/graph_edge.h"

namespace planecloud {

/// The edges of a graph. Copies share all but the last few, so that a picture of a large map costs
/// little; none sees what becomes of another.
class EdgeList {
 public:
  class const_iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = GraphEdge;
    using difference_type = std::ptrdiff_t;
    using pointer = const GraphEdge*;
    using reference = const GraphEdge&;

    const_iterator() = default;
    const_iterator(const EdgeList* list, std::size_t position) : list_(list), position_(position) {}
    reference operator*() const { return (*list_)[position_]; }
    pointer operator->() const { return &(*list_)[position_]; }
    const_iterator& operator++() {
      ++position_;
      return *this;
    }
    const_iterator operator++(int) {
      const const_iterator before = *this;
      ++position_;
      return before;
    }
    friend bool operator==(const const_iterator& a, const const_iterator& b) {
      return a.position_ == b.position_;
    }
    friend bool operator!=(const const_iterator& a, const const_iterator& b) { return !(a == b); }

   private:
    const EdgeList* list_ = nullptr;
    std::size_t position_ = 0;
  };

  [[nodiscard]] std::size_t size() const { return kBlock * blocks_.size() + tail_.size(); }
  [[nodiscard]] bool empty() const { return size() == 0; }
  /// Stays where it is until the list changes.
  [[nodiscard]] const GraphEdge& operator[](std::size_t position) const;
  [[nodiscard]] const_iterator begin() const { return {this, 0}; }
  [[nodiscard]] const_iterator end() const { return {this, size()}; }

  void push_back(const GraphEdge& edge);
  /// Puts the last edge into the place of the one at `position`, in constant time.
  void remove(std::size_t position);

 private:
  static constexpr std::size_t kBlock = 64;
  using Block = std::vector<GraphEdge>;

  void popBack();

  std::vector<std::shared_ptr<const Block>> blocks_;  ///< of `kBlock` edges each
  Block tail_;                                        ///< fewer than `kBlock`
};

}  // namespace planecloud
