// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/stereo_evidence.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/recent_landmarks.h"
#include "plumbline/map/session.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace plumbline {

// Data of a map of an atlas beside the map itself.
struct MapContext {
  Uuid uuid;
  RecentLandmarks young;
};

// Settings with which the maps of an atlas were made, and the state with which a run continues
// them.
struct AtlasContext {
  RectifiedCamera camera;  // camera of all features
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
  double octave_scale = 1.2;  // scale between octaves of the points' image pyramid
  // What is known of the pair of cameras. It is worth something only to a run with the same
  // rectified camera, turned against the left one in the same way (CameraDifference).
  StereoEvidence stereo_evidence;
  std::int32_t feature_format = 0;  // kFeatureFormat of the program that measured; 0: unknown
  std::string options_yaml;         // options that decided about the results
  std::vector<Session> sessions;    // index: KeyFrame::session
  std::map<MapId, MapContext> maps;
};

struct SavedAtlas {
  Atlas atlas;
  AtlasContext context;
  // Format version of the file it was read from; 0: not read from a file.
  std::uint32_t file_version = 0;
};

}  // namespace plumbline
