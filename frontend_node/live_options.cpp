// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/live_options.h"

#include <dynamic_reconfigure/server.h>
#include <planecloud_slam/CodecConfig.h>
#include <planecloud_slam/KeyframeConfig.h>
#include <planecloud_slam/LinkConfig.h>
#include <planecloud_slam/PlaneFitConfig.h>
#include <planecloud_slam/TextureConfig.h>

#include <algorithm>
#include <vector>

namespace planecloud {
namespace {

using planecloud_slam::CodecConfig;
using planecloud_slam::KeyframeConfig;
using planecloud_slam::LinkConfig;
using planecloud_slam::PlaneFitConfig;
using planecloud_slam::TextureConfig;

/// A budget of zero means none; between zero and the least one there is nothing.
template <typename Number>
Number zeroOrAtLeast(Number value, Number least) {
  return value > Number{0} ? std::max(value, least) : Number{0};
}

void apply(PlaneFitConfig& config, QuadtreeFitterOptions& options) {
  options.time_budget = config.time_budget;
  options.tolerance = config.tolerance;
}

void apply(CodecConfig& config, CodecOptions& options) {
  options.byte_budget = config.byte_budget = zeroOrAtLeast(config.byte_budget, 64);
}

void apply(KeyframeConfig& config, KeyframeSelectorOptions& options) {
  options.max_translation = config.max_translation;
  options.max_rotation = config.max_rotation;
  options.min_entropy_ratio = config.min_entropy_ratio;
  options.min_overlap = config.min_overlap;
}

void apply(LinkConfig& config, LinkOptions& options) {
  options.bytes_per_second = config.bytes_per_second =
      zeroOrAtLeast(config.bytes_per_second, 200.0);
}

void apply(TextureConfig& config, TextureOptions& options) {
  fromString(config.format, options.format);
  options.scale = config.scale;
  options.quality = config.quality;
  options.max_share = config.max_share;
}

/// A server and the mutex it wants to be given.
template <typename Config>
struct Server {
  explicit Server(const ros::NodeHandle& node) : server(mutex, node) {}
  boost::recursive_mutex mutex;
  dynamic_reconfigure::Server<Config> server;
};

}  // namespace

struct LiveOptions::Servers {
  std::vector<std::shared_ptr<void>> all;
};

LiveOptions::LiveOptions(const ros::NodeHandle& private_node, const FrontendNodeOptions& initial)
    : options_(initial), node_(private_node), servers_(std::make_unique<Servers>()) {
  serve<KeyframeConfig>("keyframe", options_.frontend.keyframe);
  serve<PlaneFitConfig>("plane_fit", options_.frontend.plane_fit);
  serve<CodecConfig>("codec", options_.frontend.codec);
  serve<TextureConfig>("texture", options_.frontend.texture);
  serve<LinkConfig>("link", options_.link);
}

LiveOptions::~LiveOptions() = default;

template <typename Config, typename Part>
void LiveOptions::serve(const char* part, Part& options) {
  auto server = std::make_shared<Server<Config>>(ros::NodeHandle(node_, part));
  server->server.setCallback([this, &options](Config& config, std::uint32_t) {
    const std::lock_guard<std::mutex> lock(mutex_);
    apply(config, options);
    ++changes_;
  });
  servers_->all.push_back(std::move(server));
}

std::pair<FrontendNodeOptions, std::uint64_t> LiveOptions::get() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {options_, changes_};
}

}  // namespace planecloud
