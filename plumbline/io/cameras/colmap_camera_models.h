// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace plumbline {

// A camera model of COLMAP: its number in binary files and its name in text. Its parameters are one
// focal length or two, cx, cy (pixel centres at 0.5, 0.5), and the first coefficients of a model of
// ours in our order; the others are zero.
struct ColmapCameraModel {
  std::int32_t id = 0;
  std::string_view name;
  DistortionModel model;
  std::size_t focal_lengths, coefficients;
};

// Models that are the same as one of ours. Within each of ours, those with fewer parameters first.
constexpr std::array<ColmapCameraModel, 10> kColmapCameraModels = {
    {{0, "SIMPLE_PINHOLE", DistortionModel::kNone, 1, 0},
     {1, "PINHOLE", DistortionModel::kNone, 2, 0},
     {2, "SIMPLE_RADIAL", DistortionModel::kRadTan, 1, 1},
     {3, "RADIAL", DistortionModel::kRadTan, 1, 2},
     {4, "OPENCV", DistortionModel::kRadTan, 2, 4},
     {6, "FULL_OPENCV", DistortionModel::kRational, 2, 8},
     {8, "SIMPLE_RADIAL_FISHEYE", DistortionModel::kEquidistant, 1, 1},
     {9, "RADIAL_FISHEYE", DistortionModel::kEquidistant, 1, 2},
     {5, "OPENCV_FISHEYE", DistortionModel::kEquidistant, 2, 4},
     {7, "FOV", DistortionModel::kFov, 2, 1}}};

}  // namespace plumbline
