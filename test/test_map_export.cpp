// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/map_export.h"
#include "planecloud_slam/backend_node/robot_colors.h"
#include "planecloud_slam/plane_fit/reconstruction.h"
#include "synthetic_planes.h"
#include "temporary_folder.h"

namespace planecloud {
namespace {

MapSnapshot::Node nodeOf(const std::string& robot, int number, const Eigen::Isometry3d& T) {
  auto keyframe = std::make_shared<MapKeyframe>();
  keyframe->id = {robot, 1, static_cast<std::uint32_t>(number)};
  keyframe->stamp = 1.25 + number;
  keyframe->planes = MapPlanes(std::make_shared<const PlaneCloud>(makeRoom().view(T, 0.0, 1)));
  keyframe->keyframe = std::make_shared<const Keyframe>();
  return {std::move(keyframe), T, 0};
}

/// Two keyframes of one robot, one of another, two edges.
MapSnapshot smallMap() {
  MapSnapshot map;
  map.nodes.push_back(nodeOf("a/1", 0, lookAlongX({-2.0, 0.0, 0.8}, 0.0, 0.1)));
  map.nodes.push_back(nodeOf("a/1", 1, lookAlongX({-1.5, 0.1, 0.8}, 0.2, 0.1)));
  map.nodes.push_back(nodeOf("b", 0, lookAlongX({-1.0, 0.1, 0.8}, -0.3, 0.1)));
  map.components = 1;
  for (const int to : {1, 2}) {
    GraphEdge edge;
    edge.kind = to == 1 ? EdgeKind::kOdometry : EdgeKind::kClosure;
    edge.from = map.nodes[0].keyframe->id;
    edge.to = map.nodes[static_cast<std::size_t>(to)].keyframe->id;
    edge.T_from_to =
        map.nodes[0].T_map_camera.inverse() * map.nodes[static_cast<std::size_t>(to)].T_map_camera;
    edge.information = Matrix6d::Constant(2.0) + 50.0 * Matrix6d::Identity();
    map.edges.push_back(edge);
  }
  return map;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

Eigen::Isometry3d readPose(std::istream& stream) {
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
  stream >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = t;
  return T;
}

TEST(TrajectoryText, ReadsBackToMicrometres) {
  const MapSnapshot map = smallMap();
  const std::vector<std::string> lines = linesOf(trajectoryText(map, "a/1"));
  ASSERT_EQ(lines.size(), 4u);  // two comments, two poses
  std::istringstream stream(lines[3]);
  double stamp = 0.0;
  stream >> stamp;
  EXPECT_EQ(stamp, 2.25);
  EXPECT_LT(logSe3(map.nodes[1].T_map_camera.inverse() * readPose(stream)).norm(), 2e-6);
}

TEST(G2oText, ListsVerticesEdgesAndOneFixedVertex) {
  const MapSnapshot map = smallMap();
  std::multiset<std::string> tags;
  for (const std::string& line : linesOf(g2oText(map))) tags.insert(line.substr(0, line.find(' ')));
  EXPECT_EQ(tags.count("VERTEX_SE3:QUAT"), 3u);
  EXPECT_EQ(tags.count("EDGE_SE3:QUAT"), 2u);
  EXPECT_EQ(tags.count("FIX"), 1u);
}

/// g2o's error: translation and vector part of the quaternion of T_measured^-1 T_estimate.
Vector6d g2oError(const Eigen::Isometry3d& T_measured, const Eigen::Isometry3d& T_estimate) {
  const Eigen::Isometry3d T = T_measured.inverse() * T_estimate;
  Eigen::Quaterniond q(T.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  Vector6d error;
  error << T.translation(), q.vec();
  return error;
}

TEST(G2oText, SaysTheSameSquaredErrorInG2osTerms) {
  const MapSnapshot map = smallMap();
  const std::vector<std::string> lines = linesOf(g2oText(map));
  std::istringstream stream(lines.back());
  std::string tag;
  int from = 0;
  int to = 0;
  stream >> tag >> from >> to;
  EXPECT_EQ(from, 0);
  EXPECT_EQ(to, 2);
  const Eigen::Isometry3d T_measured = readPose(stream);
  Matrix6d information;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      stream >> information(row, column);
      information(column, row) = information(row, column);
    }
  }
  ASSERT_TRUE(stream);
  Vector6d xi;
  xi << 0.01, -0.02, 0.03, 0.02, 0.01, -0.03;
  const Eigen::Isometry3d T_estimate = map.edges[1].T_from_to * expSe3(xi);
  const Vector6d error = g2oError(T_measured, T_estimate);
  const double own = xi.dot(map.edges[1].information * xi);
  // Equal up to the second order in a rotation of 0.04 rad.
  EXPECT_NEAR(error.dot(information * error), own, 0.05 * own);
}

/// A binary little-endian PLY of float32 positions and colour bytes.
struct Mesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<RobotColor> colors;
  std::size_t faces = 0;
};

Mesh readMesh(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Mesh mesh;
  std::vector<std::string> properties;  // of a vertex, "type name"
  std::size_t vertices = 0;
  bool binary = false;
  for (std::string line; std::getline(file, line) && line != "end_header";) {
    std::istringstream words(line);
    std::string first;
    std::string second;
    words >> first >> second;
    if (first == "format") binary = second == "binary_little_endian";
    if (first == "element" && second == "vertex") words >> vertices;
    if (first == "element" && second == "face") words >> mesh.faces;
    if (first == "property" && second != "list") properties.push_back(line.substr(9));
  }
  EXPECT_TRUE(binary);
  for (std::size_t i = 0; i < vertices; ++i) {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();
    RobotColor color;
    for (const std::string& property : properties) {
      const std::string name = property.substr(property.find(' ') + 1);
      if (property.rfind("float", 0) == 0) {
        float value = 0.0F;
        file.read(reinterpret_cast<char*>(&value), sizeof(value));
        if (name.size() == 1 && name[0] >= 'x') position[name[0] - 'x'] = value;
      } else {
        const auto value = static_cast<std::uint8_t>(file.get());
        if (name == "red") color.r = value;
        if (name == "green") color.g = value;
        if (name == "blue") color.b = value;
      }
    }
    mesh.positions.push_back(position);
    mesh.colors.push_back(color);
  }
  EXPECT_TRUE(file);
  return mesh;
}

TEST(ExportMap, WritesAMeshThatReadsBackInTheRobotsColours) {
  const TemporaryFolder folder;
  const MapSnapshot map = smallMap();
  const std::vector<std::string> paths = exportMap(folder.path(), map);
  ASSERT_EQ(paths.size(), 4u);
  EXPECT_EQ(paths[2], folder.path() + "/a_1_keyframes.txt");
  const Mesh mesh = readMesh(paths[0]);
  std::size_t tiles = 0;
  for (const MapSnapshot::Node& node : map.nodes) tiles += node.keyframe->planes.count();
  EXPECT_LE(mesh.faces, tiles);
  EXPECT_GT(mesh.faces, tiles * 9 / 10);
  ASSERT_EQ(mesh.positions.size(), 4 * mesh.faces);
  const RobotColor first = robotColors(map).at("a/1");
  EXPECT_EQ(mesh.colors.front().r, first.r);
  EXPECT_EQ(mesh.colors.front().b, first.b);
  const RobotColor last = robotColors(map).at("b");
  EXPECT_EQ(mesh.colors.back().g, last.g);
  for (const Eigen::Vector3f& position : mesh.positions) {  // the room, in world coordinates
    EXPECT_LT(std::abs(position.x()), 2.6);
    EXPECT_LT(std::abs(position.y()), 2.1);
  }
}

TEST(ExportMap, PaintsWhatTheCamerasSaw) {
  const TemporaryFolder folder;
  MapSnapshot map = smallMap();
  auto textured = std::make_shared<MapKeyframe>(*map.nodes[0].keyframe);
  auto received = std::make_shared<Keyframe>();
  received->planes.camera = textured->planes.camera();
  received->texture.format = "jpeg-color";
  cv::imencode(".jpg", cv::Mat(24, 32, CV_8UC3, cv::Scalar(0, 200, 0)), received->texture.bytes);
  textured->keyframe = received;
  map.nodes[0].keyframe = textured;
  const std::vector<std::string> paths = exportMap(folder.path(), map);
  const auto path = std::find(paths.begin(), paths.end(), folder.path() + "/map_textured.ply");
  ASSERT_NE(path, paths.end());
  const Mesh mesh = readMesh(*path);
  EXPECT_GT(mesh.faces, readMesh(paths[0]).faces) << "textured tiles are cut into patches";
  EXPECT_NEAR(mesh.colors.front().g, 200, 5);
  EXPECT_NEAR(mesh.colors.front().r, 0, 5);
  EXPECT_EQ(mesh.colors.back().g, robotColors(map).at("b").g) << "b has no texture";
}

TEST(ExportMap, SaysWhichFileItCannotWrite) {
  try {
    exportMap("/nonexistent/folder", smallMap());
    FAIL() << "wrote into nowhere";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nonexistent/folder/"), std::string::npos);
  }
}

}  // namespace
}  // namespace planecloud
