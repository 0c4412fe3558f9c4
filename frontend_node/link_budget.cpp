// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/link_budget.h"

namespace planecloud {

void LinkBudget::forgetBefore(double time) {
  while (!sent_.empty() && sent_.front().time < time) {
    sent_bytes_ -= sent_.front().bytes;
    sent_.pop_front();
  }
}

std::size_t LinkBudget::available(double now) {
  if (!isLimited()) return kUnlimited;
  forgetBefore(now - kWindow);
  const auto allowed = static_cast<std::size_t>(rate_ * kWindow);
  return allowed > sent_bytes_ ? allowed - sent_bytes_ : 0;
}

bool LinkBudget::admits(std::size_t bytes, double now) {
  return bytes <= available(now) || sent_.empty();
}

void LinkBudget::spend(std::size_t bytes, double now) {
  forgetBefore(now - kWindow);
  sent_.push_back({now, bytes});
  sent_bytes_ += bytes;
}

}  // namespace planecloud
