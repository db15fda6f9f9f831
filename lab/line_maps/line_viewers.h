// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/report/trajectory_error.h"
#include "worlds/true_line.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// A frame of a sequence, and the true pose of its camera.
struct LineViewer {
  int frame = 0;  // number of the frame as in TrueLine::visible
  Rigid3 camera_from_world;
};

// Viewers of true lines, and the conditions for a line to count as seen.
struct LineViewers {
  std::vector<LineViewer> frames;
  // Inward normals, in the camera frame, of the planes through the camera's centre that bound the
  // image.
  std::array<Eigen::Vector3d, 4> image_sides;
  int min_frames = 5;
  double max_distance = 6;  // distance from the camera's centre, metres
};

// Returns the keyframes of a run as viewers.
//
// The image is approximated by the ideal rectangle through the midpoints of its four borders. With
// barrel distortion that lies inside the image, whose corners are then ignored.
//
//   camera        camera of the sequence, as delivered
//   frame_stamps  stamps of the sequence, ascending
//   keyframes     stamps of the keyframes; those without a frame or an evaluated pose are skipped
//   poses         poses of the run, with their references
LineViewers ViewersOf(const Camera& camera,
                      std::span<const std::int64_t> frame_stamps,
                      std::span<const std::int64_t> keyframes,
                      std::span<const EvaluatedPose> poses);

// Returns the parts of a true line that at least min_frames of the viewers see, each from
// max_distance or nearer: inside the image, in a frame that sees some of the line. Occlusion of
// parts of the line in that frame is not known. Exact: each viewer's ball and four planes cut an
// interval out of the line. Lines without recorded frames count as seen in all.
std::vector<Stretch> SeenStretches(const TrueLine& line, const LineViewers& viewers);

}  // namespace plumbline
