// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/pyramid.h"
#include "plumbline/image/rectify.h"
#include "plumbline/map/frame.h"
#include "plumbline/slam/load_level.h"
#include "plumbline/slam/stage_clock.h"

#include <cstdint>
#include <memory>

namespace plumbline {

// A frame with the features extracted from its images.
struct ExtractedFrame {
  std::int64_t stamp_ns = 0;
  RectifiedFrame images;
  std::shared_ptr<const FrameFeatures> indexed;
  // With a single camera the pyramid of the left image, in which mapping aligns points
  // (PointAligner); else null.
  std::shared_ptr<const ImagePyramid> left_pyramid = nullptr;
  StageClock clock;  // times the frame's stages, later ones included
  LoadLevel shed = LoadLevel::kNothing;
};

}  // namespace plumbline
