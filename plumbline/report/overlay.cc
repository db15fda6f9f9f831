// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/overlay.h"

#include "plumbline/io/png.h"

namespace plumbline {
namespace {

constexpr Color kMatchedPoint{0, 230, 0};
constexpr Color kFreePoint{150, 150, 150};
constexpr Color kMatchedLine{255, 140, 0};
constexpr Color kFreeLine{70, 130, 255};

}  // namespace

void WriteFeatureOverlay(const FrameView& view, const std::filesystem::path& path) {
  const Features features = MeasuredFeatures(*view.frame.indexed);
  Overlay overlay;
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    const bool matched = view.frame.points[i].valid();
    overlay.points.push_back({features.points[i].px, matched ? kMatchedPoint : kFreePoint});
  }
  for (std::size_t i = 0; i < features.lines.size(); ++i) {
    const bool matched = view.frame.lines[i].valid();
    overlay.segments.push_back({features.lines[i].segment, matched ? kMatchedLine : kFreeLine});
  }
  WriteOverlayPng(path, view.images.left, overlay);
}

}  // namespace plumbline
