// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/image/pyramid.h"
#include "plumbline/image/rectify.h"
#include "plumbline/inertial/gyroscope.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/slam/execution.h"
#include "plumbline/slam/front_end.h"
#include "plumbline/slam/load_level.h"
#include "plumbline/slam/mapper_thread.h"
#include "plumbline/slam/monocular_initialization.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/relocalization.h"
#include "plumbline/tracking/tracker.h"

#include <memory>

namespace plumbline {

// The stages of a System, separate so that its header does not include theirs.
struct SystemStages {
  // Throws InputError like System.
  SystemStages(const Calibration& calibration,
               const SlamOptions& options,
               const Execution& execution,
               const SystemMethods& methods);

  FrontEnd front_end;
  CameraAndPyramid imaging;
  MapperThread mapping;
  Tracker tracker;
  std::unique_ptr<Gyroscope> gyroscope;  // null without an inertial sensor
  Relocalizer relocalizer;               // for live runs: in earlier snapshots
  std::unique_ptr<MonocularInitialization> monocular_initialization;  // null if depth is measured
};

// Returns the pose of the tracker's (rectified) camera at a map's first frame. The map's world is
// the left camera as delivered.
Rigid3 WorldFromFirstCamera(const Rectifier& rectifier);

// A frame whose pose was returned, with work left for the map.
struct UnfinishedFrame {
  TrackingResult result;
  LoadLevel shed = LoadLevel::kNothing;
  std::shared_ptr<const ImagePyramid> left_pyramid = nullptr;  // ExtractedFrame::left_pyramid
};

}  // namespace plumbline
