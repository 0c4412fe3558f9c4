// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/plan_legend.h"

#include <cstdio>

namespace planecloud {
namespace {

constexpr PlanColor kInk{38, 44, 52};
constexpr PlanColor kFaintInk{104, 112, 122};
constexpr double kTitleSize = 17.0;      // [px]
constexpr double kTextSize = 11.5;       // [px]
constexpr double kRowHeight = 24.0;      // [px]
constexpr double kSampleWidth = 34.0;    // of a legend entry's line [px]
constexpr double kEntryGap = 26.0;       // [px]
constexpr double kScaleBarShare = 0.16;  // of the plan's width, at most

/// The largest of 1, 2, 5 times a power of ten that is at most `length`.
double roundLength(double length) {
  double rounded = 0.001;
  for (double decade = 0.001; decade <= length; decade *= 10.0) {
    for (const double step : {1.0, 2.0, 5.0}) {
      if (step * decade <= length) rounded = step * decade;
    }
  }
  return rounded;
}

double footerTop(const PlanCanvas& canvas, const PlanLayout& layout) {
  return canvas.height() - layout.footer - 0.25 * layout.margin;
}

double scaleBarLength(const PlanLayout& layout) {
  return roundLength(kScaleBarShare * (layout.upper.x() - layout.lower.x()));
}

}  // namespace

void drawHeader(PlanCanvas& canvas, const PlanLayout& layout, const std::string& title,
                const std::string& subtitle) {
  const double left = layout.margin;
  canvas.drawText(title, {left, layout.margin + 10.0}, kTitleSize, kInk);
  canvas.drawText(subtitle, {left, layout.margin + 40.0}, kTextSize, kFaintInk);
}

void drawScaleBar(PlanCanvas& canvas, const PlanLayout& layout) {
  const double metres = scaleBarLength(layout);
  const double right = canvas.width() - layout.margin;
  const double left = right - metres * layout.pixels_per_metre;
  const double y = footerTop(canvas, layout) + kRowHeight;
  constexpr double kTick = 5.0;
  canvas.drawLine({{left, y - kTick}, {left, y}, {right, y}, {right, y - kTick}}, {kInk, 2.0});
  char label[32];
  std::snprintf(label, sizeof(label), "%g m", metres);
  const double width = PlanCanvas::textWidth(label, kTextSize);
  canvas.drawText(label, {0.5 * (left + right - width), y + 20.0}, kTextSize, kInk);
}

void drawLegend(PlanCanvas& canvas, const PlanLayout& layout,
                const std::vector<LegendEntry>& entries) {
  const double right =
      canvas.width() - layout.margin - kEntryGap - scaleBarLength(layout) * layout.pixels_per_metre;
  double x = layout.margin;
  double y = footerTop(canvas, layout) + kRowHeight;
  for (const LegendEntry& entry : entries) {
    const double width =
        kSampleWidth + 8.0 + PlanCanvas::textWidth(entry.label, kTextSize) + kEntryGap;
    if (x + width > right && x > layout.margin) {
      x = layout.margin;
      y += kRowHeight;
    }
    const double middle = y - 0.4 * kTextSize;
    canvas.drawLine({{x, middle}, {x + kSampleWidth, middle}}, entry.stroke);
    canvas.drawText(entry.label, {x + kSampleWidth + 8.0, y}, kTextSize, kInk);
    x += width;
  }
}

}  // namespace planecloud
