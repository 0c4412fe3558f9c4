// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/compression_report.h"

#include <cstdio>

#include "planecloud_slam/rosbags/sample_statistics.h"

namespace planecloud {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRawPlaneBytes = 32.0;  // the paper's 8 float32
constexpr double kMilli = 1e3;           // s to ms, m to mm

Json timesJson(const std::vector<double>& seconds) {
  const SampleStatistics statistics = summarise(seconds);
  return {{"median", kMilli * statistics.median}, {"p95", kMilli * statistics.p95}};
}

Json bytesJson(const std::vector<double>& bytes) {
  const SampleStatistics statistics = summarise(bytes);
  return {{"mean", statistics.mean},
          {"min", statistics.min},
          {"max", statistics.max},
          {"std", statistics.deviation}};
}

double meanInMilli(const std::vector<double>& values) { return kMilli * summarise(values).mean; }

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

std::string timesRow(const char* label, const std::vector<double>& seconds) {
  const SampleStatistics statistics = summarise(seconds);
  return format("%-22s %9.3f ms   (95 %%: %.3f)\n", label, kMilli * statistics.median,
                kMilli * statistics.p95);
}

std::string bytesRow(const char* label, const std::vector<double>& bytes) {
  const SampleStatistics statistics = summarise(bytes);
  return format("%-22s %9.0f B    (%.0f to %.0f, deviation %.0f)\n", label, statistics.mean,
                statistics.min, statistics.max, statistics.deviation);
}

}  // namespace

void CompressionReport::add(const CompressedFrame& frame) {
  fit_times_.push_back(frame.fit_time);
  encode_times_.push_back(frame.encode_time);
  decode_times_.push_back(frame.decode_time);
  bytes_.push_back(static_cast<double>(frame.bytes));
  texture_bytes_.push_back(static_cast<double>(frame.texture_bytes));
  lossless_bytes_.push_back(static_cast<double>(frame.lossless_bytes));
  costlier_.push_back(frame.bytes - frame.texture_bytes > frame.lossless_bytes ? 1.0 : 0.0);
  planes_.push_back(static_cast<double>(frame.planes));
  raw_bytes_.push_back(kRawPlaneBytes * planes_.back());
  coverages_.push_back(frame.coverage);
  if (frame.planes > 0) {  // an empty image has no error
    point_plane_errors_.push_back(frame.point_plane_error);
    depth_errors_.push_back(frame.depth_error);
  }
  if (!frame.truth || frame.planes == 0) return;
  true_errors_.push_back(frame.truth->compressed);
  raw_true_errors_.push_back(frame.truth->raw);
}

double CompressionReport::bitsPerPlane() const {
  const double planes = summarise(planes_).total;
  const double bytes = summarise(bytes_).total - summarise(texture_bytes_).total;
  return planes > 0.0 ? 8.0 * bytes / planes : 0.0;
}

bool CompressionReport::hasTexture() const { return summarise(texture_bytes_).total > 0.0; }

Json CompressionReport::json() const {
  Json json = {{"images", fit_times_.size()},
               {"fit_ms", timesJson(fit_times_)},
               {"encode_ms", timesJson(encode_times_)},
               {"decode_ms", timesJson(decode_times_)},
               {"bytes", bytesJson(bytes_)},
               {"raw_bytes", bytesJson(raw_bytes_)},
               {"lossless_bytes", bytesJson(lossless_bytes_)},
               {"costlier_than_lossless", summarise(costlier_).mean},
               {"planes", {{"mean", summarise(planes_).mean}}},
               {"coverage", summarise(coverages_).mean},
               {"point_plane_mm", meanInMilli(point_plane_errors_)},
               {"depth_error_mm", meanInMilli(depth_errors_)},
               {"bits_per_plane", bitsPerPlane()}};
  if (hasTexture()) json["texture_bytes"] = {{"mean", summarise(texture_bytes_).mean}};
  if (!true_errors_.empty()) {
    json["true_error_mm"] = meanInMilli(true_errors_);
    json["raw_true_error_mm"] = meanInMilli(raw_true_errors_);
  }
  return json;
}

std::string CompressionReport::table() const {
  std::string text = format("%-22s %9zu\n", "images", fit_times_.size());
  text += timesRow("fit, median", fit_times_);
  text += timesRow("encode, median", encode_times_);
  text += timesRow("decode, median", decode_times_);
  text += bytesRow("bytes, mean", bytes_);
  if (hasTexture()) text += bytesRow("of them texture, mean", texture_bytes_);
  text += bytesRow("at 32 B a plane, mean", raw_bytes_);
  text += bytesRow("lossless, mean", lossless_bytes_);
  if (summarise(costlier_).mean > 0.0) {
    text += format("%-22s %9.1f %%   (--encoding lossless is smaller and exact there)\n",
                   "costlier than lossless", 100.0 * summarise(costlier_).mean);
  }
  text += format("%-22s %9.1f\n", "planes, mean", summarise(planes_).mean);
  text += format("%-22s %9.2f\n", "bits a plane", bitsPerPlane());
  text += format("%-22s %9.2f %%\n", "coverage", 100.0 * summarise(coverages_).mean);
  text += format("%-22s %9.2f mm\n", "point to plane", meanInMilli(point_plane_errors_));
  text += format("%-22s %9.2f mm\n", "depth error", meanInMilli(depth_errors_));
  if (!true_errors_.empty()) {
    text += format("%-22s %9.2f mm   (the sensor's own: %.2f mm)\n", "to the true surface",
                   meanInMilli(true_errors_), meanInMilli(raw_true_errors_));
  }
  return text;
}

std::string CompressionReport::csvHeader() {
  return "robot,stamp,planes,bytes,texture_bytes,raw_bytes,coverage,point_plane_mm,depth_error_mm,"
         "fit_ms,"
         "encode_ms,decode_ms,true_error_mm,raw_true_error_mm";
}

std::string CompressionReport::csvLine(const CompressedFrame& frame) {
  std::string line =
      format("%s,%.6f,%zu,%zu,%zu,%.0f,%.5f,%.4f,%.4f,%.4f,%.4f,%.4f,", frame.robot.c_str(),
             frame.stamp, frame.planes, frame.bytes, frame.texture_bytes,
             kRawPlaneBytes * static_cast<double>(frame.planes), frame.coverage,
             kMilli * frame.point_plane_error, kMilli * frame.depth_error, kMilli * frame.fit_time,
             kMilli * frame.encode_time, kMilli * frame.decode_time);
  if (!frame.truth) return line + ",";
  return line + format("%.4f,%.4f", kMilli * frame.truth->compressed, kMilli * frame.truth->raw);
}

}  // namespace planecloud
