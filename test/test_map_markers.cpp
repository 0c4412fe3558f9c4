// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/map_markers.h"

namespace planecloud {
namespace {

using visualization_msgs::Marker;

KeyframeId keyframe(int number) { return {"robot1", 1, static_cast<std::uint32_t>(number)}; }

/// Keyframes along x, a metre apart, without planes.
MapSnapshot makeRow(int keyframes) {
  MapSnapshot map;
  for (int i = 0; i < keyframes; ++i) {
    auto node = std::make_shared<MapKeyframe>();
    node->id = keyframe(i);
    map.nodes.push_back({node, Eigen::Isometry3d(Eigen::Translation3d(i, 0.0, 0.0)), 0});
  }
  map.components = 1;
  return map;
}

std_msgs::Header mapHeader() {
  std_msgs::Header header;
  header.frame_id = "map";
  return header;
}

std::vector<double> placesOf(const Marker& marker) {
  std::vector<double> places;
  for (const geometry_msgs::Point& point : marker.points) places.push_back(point.x);
  return places;
}

TEST(MapMarkers, RejectedClosuresAreLinesOfANamespaceForEachReason) {
  MapSnapshot map = makeRow(4);
  map.rejected = {{keyframe(0), keyframe(3), "seen_through"},
                  {keyframe(1), keyframe(3), "ambiguous"},
                  {keyframe(0), keyframe(2), "seen_through"}};
  const std::vector<Marker> markers = makeRejectedMarkers(map, mapHeader()).markers;
  ASSERT_EQ(markers.size(), 3u);
  EXPECT_EQ(markers[0].action, Marker::DELETEALL);
  EXPECT_EQ(markers[1].ns, "ambiguous");
  EXPECT_EQ(placesOf(markers[1]), (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(markers[2].ns, "seen_through");
  EXPECT_EQ(placesOf(markers[2]), (std::vector<double>{0.0, 3.0, 0.0, 2.0}));
  for (const Marker& marker : {markers[1], markers[2]}) {
    EXPECT_EQ(marker.header.frame_id, "map");
    EXPECT_EQ(marker.type, Marker::LINE_LIST);
    EXPECT_GT(marker.color.r, 2.0F * marker.color.g);
    EXPECT_GT(marker.color.a, 0.0F);
  }
}

TEST(MapMarkers, WithoutRejectedClosuresTheOldOnesAreDeleted) {
  const std::vector<Marker> markers = makeRejectedMarkers(makeRow(2), mapHeader()).markers;
  ASSERT_EQ(markers.size(), 1u);
  EXPECT_EQ(markers[0].action, Marker::DELETEALL);
}

TEST(MapMarkers, TheGraphShowsNoRejectedClosures) {
  MapSnapshot map = makeRow(3);
  map.rejected = {{keyframe(0), keyframe(2), "seen_through"}};
  for (const Marker& marker : makeGraphMarkers(map, mapHeader()).markers) {
    if (marker.ns == "keyframes") continue;
    EXPECT_TRUE(marker.points.empty()) << marker.ns;
  }
}

}  // namespace
}  // namespace planecloud
