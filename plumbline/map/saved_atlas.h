// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/feature_correction.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/landmarks.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace plumbline {

// A universally unique name of a session or map, across files (RFC 9562). Made from contents
// instead of random numbers, version 8: the same input gives the same bytes.
struct Uuid {
  std::array<std::uint8_t, 16> bytes{};  // all 0: no name

  friend auto operator<=>(const Uuid&, const Uuid&) = default;
};

// Returns, for example, "f81d4fae-7dec-81d0-a765-00a0c91e6bf6".
std::string ToString(const Uuid& uuid);

// Returns the name of an object that the bytes describe.
Uuid UuidOf(const std::string& contents);

// One run of the camera. Stamps and frame numbers of different sessions may be the same.
struct Session {
  Uuid uuid;
  std::string program;  // version of the program that ran
  // Name of the data set, in files of earlier versions; otherwise empty.
  std::string data;
  std::int64_t first_stamp_ns = 0;
  std::int64_t last_stamp_ns = 0;
};

// Data of a map of an atlas beside the map itself.
struct MapContext {
  Uuid uuid;
  LandmarkIds young;  // created recently, still on probation
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
