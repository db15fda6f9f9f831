// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/loop/landmark_alignment.h"
#include "plumbline/map/map.h"

#include <optional>
#include <vector>

namespace plumbline {

// A keyframe with the landmarks around it: its own and those of the keyframes that see the same.
struct LocalLandmarks {
  const KeyFrame* keyframe = nullptr;
  std::vector<KeyFrameId> neighbours;   // most covisible first
  std::vector<const MapPoint*> points;  // by id
  std::vector<const MapLine*> lines;    // by id
};

// With the `neighbours` most covisible keyframes. BugError where the map has no such keyframe.
// O(their matches).
LocalLandmarks LandmarksAround(const Map& map, KeyFrameId id, int neighbours);

// A point in the frame of a camera, with the covariance that its observations (the newest eight)
// leave it with the keyframes where they are. Depth nothing is known of has a deviation of itself.
CameraPoint PointInCamera(const RectifiedCamera& camera,
                          const Map& map,
                          const MapPoint& point,
                          const Rigid3& cam_from_world);

// The line in the frame of a camera.
LineModel LineInCamera(const MapLine& line, const Rigid3& cam_from_world);

// The pose of a camera in the world of other landmarks, in their unit: their keyframe's pose, and
// how their keyframe's camera is seen from the camera. Directions are right for any scale.
Rigid3 CameraAmong(const Rigid3& keyframe_from_world, const Similarity3& camera_from_keyframe);

// Landmarks searched for in an image.
struct SearchedImage {
  std::vector<std::optional<ProjectedPoint>> projected_points;  // by landmark; nullopt: not in view
  std::vector<std::optional<ProjectedLine>> projected_lines;
  std::vector<LandmarkMatch> points, lines;  // landmark: index; feature of the image
  int tested_points = 0, tested_lines = 0;   // in view
};

SearchedImage SearchImage(const ImagingModel& imaging,
                          const LocalLandmarks& landmarks,
                          const Rigid3& cam_from_world,
                          const IndexedFeatures& image,
                          const ProjectionSearchOptions& options);

}  // namespace plumbline
