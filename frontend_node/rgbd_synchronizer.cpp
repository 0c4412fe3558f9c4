// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/rgbd_synchronizer.h"

#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>

#include <boost/bind/bind.hpp>
#include <utility>

namespace planecloud {
namespace {

using Event = ros::MessageEvent<sensor_msgs::Image const>;
using ApproximatePolicy =
    message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::Image>;
using ExactPolicy =
    message_filters::sync_policies::ExactTime<sensor_msgs::Image, sensor_msgs::Image>;

}  // namespace

class RgbdSynchronizer::Policy {
 public:
  Policy(const InputOptions& options, const OnPair& on_pair) {
    const auto queue = static_cast<std::uint32_t>(options.sync_queue);
    const auto callback = boost::bind(on_pair, boost::placeholders::_1, boost::placeholders::_2);
    if (options.exact_sync) {
      exact_ = std::make_unique<Exact>(ExactPolicy(queue));
      exact_->registerCallback(callback);
    } else {
      ApproximatePolicy policy(queue);
      policy.setMaxIntervalDuration(ros::Duration(options.max_interval));
      approximate_ = std::make_unique<Approximate>(policy);
      approximate_->registerCallback(callback);
    }
  }

  template <int kInput>
  void add(const sensor_msgs::ImageConstPtr& image) {
    if (exact_) exact_->template add<kInput>(Event(image));
    if (approximate_) approximate_->template add<kInput>(Event(image));
  }

 private:
  using Exact = message_filters::Synchronizer<ExactPolicy>;
  using Approximate = message_filters::Synchronizer<ApproximatePolicy>;
  std::unique_ptr<Exact> exact_;
  std::unique_ptr<Approximate> approximate_;
};

RgbdSynchronizer::RgbdSynchronizer(const InputOptions& options, OnPair on_pair)
    : options_(options), on_pair_(std::move(on_pair)) {
  clear();
}

RgbdSynchronizer::~RgbdSynchronizer() = default;

void RgbdSynchronizer::addColor(const sensor_msgs::ImageConstPtr& color) { policy_->add<0>(color); }

void RgbdSynchronizer::addDepth(const sensor_msgs::ImageConstPtr& depth) { policy_->add<1>(depth); }

void RgbdSynchronizer::clear() { policy_ = std::make_unique<Policy>(options_, on_pair_); }

}  // namespace planecloud
