// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace planecloud {

/// A first-in first-out queue between one or more producers and consumers.
/// After `close()` nothing more enters; what is inside can still be taken.
template <typename Item>
class BoundedQueue {
 public:
  /// `capacity` 0 means unbounded.
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  /// Waits for room. Returns false, and drops `item`, when the queue is closed.
  bool push(Item item) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || hasRoom(); });
    if (closed_) return false;
    items_.push_back(std::move(item));
    changed_.notify_all();
    return true;
  }

  /// Never waits: makes room by dropping the oldest. Returns how many items were dropped
  /// (the new one itself counts when the queue is closed).
  std::size_t pushDroppingOldest(Item item) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return 1;
    std::size_t dropped = 0;
    for (; !hasRoom(); ++dropped) items_.pop_front();
    items_.push_back(std::move(item));
    changed_.notify_all();
    return dropped;
  }

  /// Waits for an item; empty once the queue is closed and drained.
  [[nodiscard]] std::optional<Item> pop() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !items_.empty(); });
    if (items_.empty()) return std::nullopt;
    std::optional<Item> item(std::move(items_.front()));
    items_.pop_front();
    changed_.notify_all();
    return item;
  }

  /// Wakes everybody; producers are refused from now on.
  void close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  [[nodiscard]] std::size_t size() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return items_.size();
  }

 private:
  [[nodiscard]] bool hasRoom() const { return capacity_ == 0 || items_.size() < capacity_; }

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;
  bool closed_ = false;
};

}  // namespace planecloud
