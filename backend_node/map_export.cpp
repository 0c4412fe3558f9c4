// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/map_export.h"

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "planecloud_slam/backend_node/robot_colors.h"
#include "planecloud_slam/plane_fit/reconstruction.h"

namespace planecloud {
namespace {

/// `%.9g` keeps all digits of the float32 that information travels as.
std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

std::string poseText(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d t = T.translation();
  Eigen::Quaterniond q(T.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  char text[192];
  std::snprintf(text, sizeof(text), "%.6f %.6f %.6f %.7f %.7f %.7f %.7f", t.x(), t.y(), t.z(),
                q.x(), q.y(), q.z(), q.w());
  return text;
}

std::string edgeText(const GraphEdge& edge, const std::map<KeyframeId, std::size_t>& vertices) {
  Vector6d scale;
  scale << 1.0, 1.0, 1.0, 2.0, 2.0, 2.0;
  const Matrix6d information = scale.asDiagonal() * edge.information * scale.asDiagonal();
  std::string text = "EDGE_SE3:QUAT " + std::to_string(vertices.at(edge.from)) + " " +
                     std::to_string(vertices.at(edge.to)) + " " + poseText(edge.T_from_to);
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) text += " " + number(information(row, column));
  }
  return text + "\n";
}

/// Side of the patches that tiles are cut into for texture [px].
constexpr int kTexturedPatch = 16;

/// The tile, cut into patches of at most `side` pixels.
std::vector<PlanarTile> cut(const PlanarTile& tile, int side) {
  std::vector<PlanarTile> patches;
  for (int y = 0; y < tile.rect.height; y += side) {
    for (int x = 0; x < tile.rect.width; x += side) {
      PlanarTile patch = tile;
      patch.rect = {tile.rect.x + x, tile.rect.y + y, std::min(side, tile.rect.width - x),
                    std::min(side, tile.rect.height - y)};
      patches.push_back(patch);
    }
  }
  return patches;
}

class PlaneMesh {
 public:
  explicit PlaneMesh(MapColoring coloring) : coloring_(coloring) {}

  void add(const MapSnapshot::Node& node, const RobotColor& color) {
    const PlaneCloud& planes = *node.keyframe->planes;
    const KeyframeColors colors = coloring_ == MapColoring::kTexture
                                      ? KeyframeColors(*node.keyframe->keyframe)
                                      : KeyframeColors();
    for (const PlanarTile& tile : planes.tiles) {
      const int side =
          colors.empty() ? std::max(tile.rect.width, tile.rect.height) : kTexturedPatch;
      for (const PlanarTile& patch : cut(tile, side)) {
        const auto corners = tileCorners(patch, planes.camera);
        if (corners) addQuadrilateral(*corners, node.T_map_camera, {colors, color});
      }
    }
  }

  void write(const std::string& path) {
    pcl::toPCLPointCloud2(vertices_, mesh_.cloud);
    if (pcl::io::savePLYFileBinary(path, mesh_) != 0) {
      throw std::runtime_error("cannot write plane map '" + path + "'");
    }
  }

 private:
  struct Paint {
    const KeyframeColors& texture;
    const RobotColor& robot;
  };

  void addQuadrilateral(const std::array<Eigen::Vector3d, 4>& corners,
                        const Eigen::Isometry3d& T_map_camera, const Paint& paint) {
    pcl::Vertices quadrilateral;
    for (const std::size_t i : {0, 3, 2, 1}) {  // counter-clockwise seen from the camera
      quadrilateral.vertices.push_back(
          static_cast<decltype(quadrilateral.vertices)::value_type>(vertices_.size()));
      vertices_.push_back(
          vertexAt(T_map_camera * corners[i], paint.texture.at(corners[i], paint.robot)));
    }
    mesh_.polygons.push_back(std::move(quadrilateral));
  }

  static pcl::PointXYZRGB vertexAt(const Eigen::Vector3d& point, const RobotColor& color) {
    pcl::PointXYZRGB vertex(color.r, color.g, color.b);
    vertex.getVector3fMap() = point.cast<float>();
    return vertex;
  }

  const MapColoring coloring_;
  pcl::PointCloud<pcl::PointXYZRGB> vertices_;
  pcl::PolygonMesh mesh_;
};

/// Robot names may be namespaces.
std::string fileName(std::string robot) {
  std::replace(robot.begin(), robot.end(), '/', '_');
  return robot;
}

bool hasTexture(const MapSnapshot& snapshot) {
  return std::any_of(snapshot.nodes.begin(), snapshot.nodes.end(), [](const auto& node) {
    return !node.keyframe->keyframe->texture.bytes.empty();
  });
}

void writeText(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write '" + path + "'");
}

}  // namespace

std::string tumLine(double stamp, const Eigen::Isometry3d& T) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.6f", stamp);
  return text + (" " + poseText(T));
}

std::string trajectoryText(const MapSnapshot& snapshot, const std::string& robot) {
  std::vector<const MapSnapshot::Node*> nodes;
  for (const MapSnapshot::Node& node : snapshot.nodes) {
    if (node.keyframe->id.robot == robot) nodes.push_back(&node);
  }
  std::stable_sort(nodes.begin(), nodes.end(), [](const auto* a, const auto* b) {
    return a->keyframe->stamp < b->keyframe->stamp;
  });
  std::string text = "# stamp tx ty tz qx qy qz qw\n";
  int component = -1;
  for (const MapSnapshot::Node* node : nodes) {
    if (node->component != component) {
      component = node->component;
      text += "# component " + std::to_string(component) + "\n";
    }
    text += tumLine(node->keyframe->stamp, node->T_map_camera) + "\n";
  }
  return text;
}

std::string g2oText(const MapSnapshot& snapshot) {
  std::string text;
  std::map<KeyframeId, std::size_t> vertices;
  std::set<int> fixed;
  for (std::size_t i = 0; i < snapshot.nodes.size(); ++i) {
    const MapSnapshot::Node& node = snapshot.nodes[i];
    vertices.emplace(node.keyframe->id, i);
    text += "VERTEX_SE3:QUAT " + std::to_string(i) + " " + poseText(node.T_map_camera) + "\n";
    if (fixed.insert(node.component).second) text += "FIX " + std::to_string(i) + "\n";
  }
  for (const GraphEdge& edge : snapshot.edges) text += edgeText(edge, vertices);
  return text;
}

void writePlaneMap(const std::string& path, const MapSnapshot& snapshot, MapColoring coloring) {
  const std::map<std::string, RobotColor> colors = robotColors(snapshot);
  PlaneMesh mesh(coloring);
  for (const MapSnapshot::Node& node : snapshot.nodes) {
    mesh.add(node, colors.at(node.keyframe->id.robot));
  }
  mesh.write(path);
}

std::vector<std::string> exportMap(const std::string& directory, const MapSnapshot& snapshot) {
  std::vector<std::string> paths{directory + "/map.ply", directory + "/graph.g2o"};
  writeText(paths[1], g2oText(snapshot));
  writePlaneMap(paths[0], snapshot);
  if (hasTexture(snapshot)) {
    paths.push_back(directory + "/map_textured.ply");
    writePlaneMap(paths.back(), snapshot, MapColoring::kTexture);
  }
  for (const auto& [robot, color] : robotColors(snapshot)) {
    paths.push_back(directory + "/" + fileName(robot) + "_keyframes.txt");
    writeText(paths.back(), trajectoryText(snapshot, robot));
  }
  return paths;
}

}  // namespace planecloud
