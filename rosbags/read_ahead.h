// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "planecloud_slam/plane_fit/bounded_queue.h"

namespace planecloud {

/// Runs a source in a thread of its own, some items ahead of who takes them. The source's
/// exception is thrown by `next()` once the items before it are taken.
template <typename Item>
class ReadAhead {
 public:
  using Source = std::function<std::optional<Item>()>;

  ReadAhead(Source source, std::size_t ahead)
      : source_(std::move(source)), queue_(ahead), thread_([this] { run(); }) {}
  ~ReadAhead() {
    queue_.close();
    thread_.join();
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  [[nodiscard]] std::optional<Item> next() {
    std::optional<Item> item = queue_.pop();
    if (!item && error_) std::rethrow_exception(error_);
    return item;
  }

 private:
  void run() {
    try {
      while (std::optional<Item> item = source_()) {
        if (!queue_.push(std::move(*item))) return;
      }
    } catch (...) {
      error_ = std::current_exception();  // published by close()
    }
    queue_.close();
  }

  Source source_;
  BoundedQueue<Item> queue_;
  std::exception_ptr error_;
  std::thread thread_;  // last: runs on the members above
};

}  // namespace planecloud
