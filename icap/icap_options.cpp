// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/icap_options.h"

#include <stdexcept>

namespace planecloud {
namespace {

constexpr double kSmallest = 1e-6;

}  // namespace

std::string toString(IcapForm form) {
  switch (form) {
    case IcapForm::kPaper:
      return "paper";
    case IcapForm::kRobust:
      return "robust";
  }
  throw std::invalid_argument("icap/form: not an enumerator");
}

void fromString(const std::string& text, IcapForm& form) {
  if (text == "paper") {
    form = IcapForm::kPaper;
  } else if (text == "robust") {
    form = IcapForm::kRobust;
  } else {
    throw std::invalid_argument("icap/form = " + text + ": must be paper or robust");
  }
}

void PlaneSetOptions::check() const {
  checkRange("icap/coarse_tile", coarse_tile, 4, 64);
  checkRange("icap/fine_tile", fine_tile, 2, 64);
  checkRange("icap/min_tile", min_tile, 1, 64);
  checkRange("icap/max_depth", max_depth, 0.5, 50.0);
  checkRange("icap/min_incidence", min_incidence, 0.0, 0.9);
  checkRange("icap/coarse_kept", coarse_kept, 16, 100000);
  checkRange("icap/fine_patches", fine_patches, 16, 100000);
  checkRange("icap/depth_noise", depth_noise, 1e-5, 0.1);
  checkRange("icap/depth_bias", depth_bias, 0.0, 0.1);
  checkRange("icap/noise_correlation", noise_correlation, 1.0, 32.0);
}

void VisibilityOptions::check() const {
  checkRange("icap/depth_tolerance", depth_tolerance, kSmallest, 1.0);
  checkRange("icap/depth_tolerance_z2", depth_tolerance_z2, 0.0, 0.1);
  checkRange("icap/normal_tolerance", normal_tolerance, kSmallest, 1.6);
}

void IcapOptions::check() const {
  checkRange("icap/max_iterations", max_iterations, 1, 200);
  checkRange("icap/min_matches", min_matches, 3, 10000);
  checkRange("icap/coarse_patches", coarse_patches, 16, 100000);
  checkRange("icap/initial_distance", initial_distance, kSmallest, 5.0);
  checkRange("icap/final_distance", final_distance, kSmallest, 5.0);
  checkRange("icap/coarse_normal_length", coarse_normal_length, kSmallest, 10.0);
  checkRange("icap/fine_normal_length", fine_normal_length, kSmallest, 10.0);
  checkRange("icap/initial_angle", initial_angle, kSmallest, 3.2);
  checkRange("icap/final_angle", final_angle, kSmallest, 3.2);
  checkRange("icap/distance_floor", distance_floor, kSmallest, 1.0);
  checkRange("icap/normal_floor", normal_floor, kSmallest, 1.0);
  checkRange("icap/kernel_width", kernel_width, 0.5, 100.0);
  checkRange("icap/final_kernel_width", final_kernel_width, 0.5, 100.0);
  checkRange("icap/observability", observability, 0.0, 1000.0);
  checkRange("icap/max_correction", max_correction, kSmallest, 100.0);
  checkRange("icap/max_rotation", max_rotation, kSmallest, 3.2);
  checkRange("icap/translation_floor", translation_floor, 0.0, 1.0);
  checkRange("icap/rotation_floor", rotation_floor, 0.0, 1.0);
  planes.check();
  visibility.check();
}

}  // namespace planecloud
