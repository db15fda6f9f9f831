// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/loop_closing/landmark_alignment.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <optional>
#include <vector>

namespace plumbline {

// A keyframe and its local landmarks: its own, and those of covisible keyframes.
struct LocalLandmarks {
  const KeyFrame* keyframe = nullptr;
  std::vector<KeyFrameId> neighbours;   // ordered by covisibility, the highest first
  std::vector<const MapPoint*> points;  // ordered by id
  std::vector<const MapLine*> lines;    // ordered by id
};

// Returns a keyframe with its landmarks and those of the `neighbours` most covisible keyframes.
// Throws BugError if the map has no such keyframe. O(their matches).
LocalLandmarks LandmarksAround(const Map& map, KeyFrameId id, int neighbours);

// Returns a point in the frame of a camera, with the covariance from its newest eight observations
// with fixed keyframes. Directions that they leave undetermined get the distance from the camera as
// standard deviation.
CameraPoint PointInCamera(const RectifiedCamera& camera,
                          const Map& map,
                          const MapPoint& point,
                          const Rigid3& cam_from_world);

// Returns the line in the frame of a camera.
LineModel LineInCamera(const MapLine& line, const Rigid3& cam_from_world);

// Returns the pose of a camera in the world of other landmarks, in their scale, from the pose of
// their keyframe and that keyframe's pose relative to the camera. Directions are right for any
// scale.
Rigid3 CameraAmong(const Rigid3& keyframe_from_world, const Similarity3& camera_from_keyframe);

// Result of a search for landmarks in an image.
struct SearchedImage {
  // One for each point; nullopt if the point is not in view.
  std::vector<std::optional<ProjectedPoint>> projected_points;
  std::vector<std::optional<ProjectedLine>> projected_lines;
  std::vector<LandmarkMatch> points, lines;  // landmark: its index; feature: that of the image
  int tested_points = 0, tested_lines = 0;   // number of landmarks in view
};

// Projects landmarks into an image and finds matching features near their projections.
SearchedImage SearchImage(const CameraAndPyramid& imaging,
                          const LocalLandmarks& landmarks,
                          const Rigid3& cam_from_world,
                          const FrameFeatures& image,
                          const ProjectionSearchOptions& options);

}  // namespace plumbline
