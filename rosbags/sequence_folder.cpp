// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/sequence_folder.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "planecloud_slam/rosbags/camera_file.h"
#include "planecloud_slam/rosbags/trajectory_file.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

namespace fs = std::filesystem;

std::string sizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

SequencePair parseAssociation(const std::string& line, const std::string& place) {
  std::istringstream words(line);
  SequencePair pair;
  std::string rest;
  if (!(words >> pair.color_stamp >> pair.color_path >> pair.depth_stamp >> pair.depth_path) ||
      words >> rest) {
    throw std::runtime_error(place + ": expected 'stamp rgb/file stamp depth/file', got '" + line +
                             "'");
  }
  // Both orders of the benchmark's associate.py are in use.
  if (pair.color_path.rfind("depth/", 0) == 0) {
    std::swap(pair.color_path, pair.depth_path);
    std::swap(pair.color_stamp, pair.depth_stamp);
  }
  return pair;
}

std::vector<SequencePair> readAssociations(const std::string& folder) {
  const std::string path = folder + "/associations.txt";
  std::ifstream file(path);
  if (!file) {
    throw std::runtime_error("cannot read '" + path +
                             "': a sequence needs it, 'stamp rgb/file stamp depth/file' a line "
                             "(the benchmark's associate.py writes it)");
  }
  std::vector<SequencePair> pairs;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos || line.front() == '#') continue;
    const std::string place = path + ":" + std::to_string(number);
    SequencePair pair = parseAssociation(line, place);
    for (std::string* image : {&pair.color_path, &pair.depth_path}) {
      *image = folder + "/" + *image;
      if (!fs::is_regular_file(*image)) {
        throw std::runtime_error(place + ": there is no file '" + *image +
                                 "'; restore it or take the line out");
      }
    }
    pairs.push_back(std::move(pair));
  }
  if (pairs.empty()) throw std::runtime_error(path + ": no pair of images in it");
  return pairs;
}

cv::Mat readImage(const std::string& path, int flags) {
  cv::Mat image = cv::imread(path, flags);
  if (image.empty()) {
    throw std::runtime_error("cannot read image '" + path +
                             "': it is damaged or of unknown format");
  }
  return image;
}

cv::Mat readDepthImage(const std::string& path) {
  cv::Mat depth = readImage(path, cv::IMREAD_UNCHANGED);
  if (depth.type() != CV_16UC1) {
    throw std::runtime_error("'" + path +
                             "' is not a depth image: it must have one channel of 16 "
                             "bits");
  }
  return depth;
}

/// Options before camera.yaml before the images' size.
void chooseCamera(SequenceFolder& folder, const SequenceOptions& options) {
  CameraFile file;
  const std::string path = folder.path + "/camera.yaml";
  const bool has_file = fs::exists(path);
  if (has_file) file = readCameraFile(path);
  if (!options.camera && !has_file) {
    throw UsageError("'" + folder.path +
                     "' has no camera.yaml: give the camera, e.g. --camera "
                     "525,525,319.5,239.5, or write a camera.yaml with fx, fy, cx, cy");
  }
  folder.camera = options.camera ? *options.camera : file.camera;
  if (options.camera && folder.camera.width == 0) {
    folder.camera.width = file.camera.width;
    folder.camera.height = file.camera.height;
  }
  if (file.depth_scale) folder.depth_scale = *file.depth_scale;
  if (options.depth_scale) folder.depth_scale = *options.depth_scale;
  if (folder.camera.width == 0) {
    const cv::Mat depth = readDepthImage(folder.pairs.front().depth_path);
    folder.camera.width = depth.cols;
    folder.camera.height = depth.rows;
  }
  folder.camera.check();
}

Image<float> metres(const cv::Mat& depth, double scale) {
  Image<float> result(depth.cols, depth.rows, std::numeric_limits<float>::quiet_NaN());
  for (int y = 0; y < depth.rows; ++y) {
    const auto* source = depth.ptr<std::uint16_t>(y);
    float* target = result.row(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (source[x] != 0) target[x] = static_cast<float>(source[x] / scale);
    }
  }
  return result;
}

}  // namespace

SequenceFolder openSequenceFolder(const std::string& path, const SequenceOptions& options) {
  if (!fs::is_directory(path)) throw std::runtime_error("there is no folder '" + path + "'");
  SequenceFolder folder;
  folder.path = path;
  folder.pairs = readAssociations(path);
  chooseCamera(folder, options);
  if (!(folder.depth_scale > 0.0) || !std::isfinite(folder.depth_scale)) {
    throw UsageError("depth scale = " + std::to_string(folder.depth_scale) +
                     ": must be the depth pixels per metre, e.g. 5000");
  }
  const std::string ground_truth = path + "/groundtruth.txt";
  if (fs::exists(ground_truth)) folder.ground_truth = readTrajectory(ground_truth);
  return folder;
}

SequenceImages readSequenceImages(const SequenceFolder& folder, const SequencePair& pair) {
  SequenceImages images;
  images.color = readImage(pair.color_path, cv::IMREAD_COLOR);
  const cv::Mat depth = readDepthImage(pair.depth_path);
  if (images.color.size() != depth.size()) {
    throw std::runtime_error("'" + pair.color_path + "' has " +
                             sizeText(images.color.cols, images.color.rows) + " pixels, '" +
                             pair.depth_path + "' has " + sizeText(depth.cols, depth.rows) +
                             ": depth must be registered to colour");
  }
  if (depth.cols != folder.camera.width || depth.rows != folder.camera.height) {
    throw std::runtime_error("'" + pair.depth_path + "' has " + sizeText(depth.cols, depth.rows) +
                             " pixels, the camera " +
                             sizeText(folder.camera.width, folder.camera.height) +
                             ": correct camera.yaml or the image");
  }
  images.depth = metres(depth, folder.depth_scale);
  return images;
}

Image<std::uint8_t> greyFromColor(const cv::Mat& color) {
  cv::Mat grey;
  cv::cvtColor(color, grey, cv::COLOR_BGR2GRAY);
  Image<std::uint8_t> image(grey.cols, grey.rows);
  for (int y = 0; y < grey.rows; ++y) {
    std::memcpy(image.row(y), grey.ptr(y), static_cast<std::size_t>(grey.cols));
  }
  return image;
}

}  // namespace planecloud
