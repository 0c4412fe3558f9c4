// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/graph_edge.h"

namespace planecloud {

/// The edges of a graph, packed to a third of their size. Copies share all but the last few, so
/// that a picture of a large map costs little; none sees what becomes of another. Poses come back
/// but for the rounding of a quaternion, information matrices symmetric, without negative
/// eigenvalues and to single precision, what they do not observe unobserved.
class EdgeList {
 public:
  class const_iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = GraphEdge;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = GraphEdge;

    const_iterator() = default;
    const_iterator(const EdgeList* list, std::size_t position) : list_(list), position_(position) {}
    reference operator*() const { return (*list_)[position_]; }
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
  [[nodiscard]] GraphEdge operator[](std::size_t position) const;
  /// `(*this)[position].kind`, at no cost.
  [[nodiscard]] EdgeKind kind(std::size_t position) const { return packed(position).kind; }
  [[nodiscard]] const_iterator begin() const { return {this, 0}; }
  [[nodiscard]] const_iterator end() const { return {this, size()}; }

  void push_back(const GraphEdge& edge);
  /// Puts the last edge into the place of the one at `position`, in constant time.
  void remove(std::size_t position);

 private:
  static constexpr std::size_t kBlock = 64;
  static constexpr std::size_t kTriangle = 21;  // of a symmetric 6 x 6 matrix

  /// A run of a robot's frontend.
  struct Session {
    std::string robot;
    std::uint64_t number = 0;
  };
  struct End {
    std::uint32_t session = 0;  ///< position in `sessions_`
    std::uint32_t number = 0;
  };
  struct Packed {
    End from;
    End to;
    std::array<double, 3> translation{};
    std::array<double, 4> rotation{};  ///< quaternion x y z w
    /// R, upper triangle row by row, of the information R^T R: rounding R leaves a direction
    /// without information without, as rounding the information would not.
    std::array<float, kTriangle> root_information{};
    EdgeKind kind = EdgeKind::kOdometry;
    bool inter_robot = false;
  };
  using Block = std::vector<Packed>;

  [[nodiscard]] const Packed& packed(std::size_t position) const;
  [[nodiscard]] End pack(const KeyframeId& id);
  [[nodiscard]] KeyframeId unpack(const End& end) const;
  void append(const Packed& edge);
  void popBack();

  std::vector<Session> sessions_;
  std::vector<std::shared_ptr<const Block>> blocks_;  ///< of `kBlock` edges each
  Block tail_;                                        ///< fewer than `kBlock`
};

}  // namespace planecloud
