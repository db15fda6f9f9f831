// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/image/color_image.h"
#include "plumbline/image/image.h"

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

struct OverlayPoint {
  Eigen::Vector2d px;
  Color color{0, 220, 0};
};

struct OverlaySegment {
  Segment2 segment;
  Color color{255, 140, 0};
};

// Features to draw on an image. Positions in pixels of the image, centres at integers.
struct Overlay {
  std::vector<OverlayPoint> points;
  std::vector<OverlaySegment> segments;
};

// Returns the image with the overlay as the bytes of a PNG file (segments below points,
// antialiased).
std::string EncodeOverlayPng(const GrayImage& image, const Overlay& overlay);

// Writes a grey image as PNG. All functions below throw InputError if the file cannot be written.
void WriteGrayPng(const std::filesystem::path& path, const GrayImage& image);
// Writes an image in colour as PNG, of one channel if red, green and blue are the same.
void WriteColorPng(const std::filesystem::path& path, const ColorImage& image);
// Writes depth as 16-bit PNG, rounded depth * factor; 0 if it does not fit.
void WriteDepthPng(const std::filesystem::path& path, const DepthImage& depth, double factor);
void WriteOverlayPng(const std::filesystem::path& path,
                     const GrayImage& image,
                     const Overlay& overlay);

}  // namespace plumbline
