// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/pose_uncertainty.h"

#include <array>
#include <type_traits>

namespace plumbline {

struct LineMapOptions {
  int min_keyframes = 4;             // keyframes that must show each point of a line
  double max_relative_sigma = 0.02;  // deviation of each point of a line, over its distance
  // Share of the keyframes with a line in their image that must show it.
  double min_found_ratio = 0.25;
  // Largest mean chi2 of the segments of a line, of two residuals each.
  double max_mean_chi2 = 5;
  double min_mean_length_px = 35;  // mean length of the segments of a line
};

template <class Visitor>
void VisitFields(Visitor&& visit, LineMapOptions& o) {
  visit("min_keyframes",
        o.min_keyframes,
        "keyframes that must show each point of a line",
        Range{2, 100});
  visit("max_relative_sigma",
        o.max_relative_sigma,
        "largest deviation of each point of a line, relative to its distance from the nearest "
        "keyframe that shows the line",
        Range{0.0001, 1});
  visit(
      "min_found_ratio",
      o.min_found_ratio,
      "of the keyframes that have a line in their image, before it or behind something, the share "
      "that must show it",
      Range{0, 1});
  visit("max_mean_chi2",
        o.max_mean_chi2,
        "largest mean of the chi2 of the segments that show a line; 2 where they are as far off as "
        "their own deviations say",
        Range{0.1, 1000});
  visit("min_mean_length_px",
        o.min_mean_length_px,
        "smallest mean length of the segments that show a line, pixels",
        Range{0, 1000});
}

// Constants of new landmarks, no options of a run; load control lowers some, and tests set them.
struct LandmarkCreationOptions {
  // Largest deviation, relative to the depth, of points made from one stereo or RGB-D frame. Less
  // certain ones are made of two views.
  double max_relative_depth_sigma = 0.04;
  // With fewer such points than this, the most certain others are made, too: a pose needs some.
  int min_depth_points = 100;
  // Largest deviation, relative to the depth, of the ends of lines made from one frame. With
  // wider limits, lines alone give less accurate poses (lab/notes/mapping.md).
  double max_relative_line_depth_sigma = 0.107;
  // Number of keyframes, the closest ones, searched for a second view of points without landmark.
  int neighbours = 6;
};

struct CleanupOptions {
  // Share of a keyframe's landmarks that three others must show to make it redundant.
  double redundant_share = 0.9;
  double revisited_share = 0.7;  // redundant_share at revisited places
};

template <class Visitor>
void VisitFields(Visitor&& visit, CleanupOptions& o) {
  visit("redundant_share",
        o.redundant_share,
        "share of landmarks seen by three others that makes a keyframe redundant; 1: never",
        Range{0.1, 1});
  visit("revisited_share",
        o.revisited_share,
        "the same share where one of these keyframes is of another visit to the place, more than "
        "20 keyframes before or after; 1: never",
        Range{0.1, 1});
}

// What local bundle adjustment adjusts. All but parallel_lines are constants, no options of a run;
// load control lowers some, and tests set them.
struct LocalBaWindowOptions {
  // Number of adjusted keyframes, closest in covisibility. The time grows with it.
  int free_keyframes = 12;
  // Largest number of fixed keyframes, which see the same landmarks and fix the window.
  int fixed_keyframes = 20;
  // Least angle between the views of a line in the window, unless its ends are certain: lines seen
  // under less move where noise pulls them.
  double min_line_plane_angle_deg = 10;
  // Largest deviation of certain ends, relative to their depth.
  double max_line_relative_sigma = 0.05;
  // Largest uncertainty of an adjusted keyframe's pose (PoseUncertainty), and, at the end of a run,
  // largest change of two consecutive keyframes against one another: rotation [rad], translation
  // relative to the depth of the landmarks. With points it is 0.0003 or less.
  double max_pose_sigma = 0.01;
  // Largest correction of a keyframe relative to the one before, in one window. It is wider, since
  // it has the errors of tracking to correct (docs/methods/mapping.md).
  double max_correction = 0.03;
  bool parallel_lines = true;  // true: lines keep to directions shared by many lines of the map

  PoseLimits local_limits() const { return {.sigma = max_pose_sigma, .change = max_correction}; }
  PoseLimits whole_map_limits() const {
    return {.sigma = max_pose_sigma, .change = max_pose_sigma};
  }
};

template <class Visitor>
void VisitFields(Visitor&& visit, LocalBaWindowOptions& o) {
  visit("parallel_lines",
        o.parallel_lines,
        "lines that are parallel to many others of the map by chi2 are held so");
}

// The options of local bundle adjustment that a run has; LocalBaOptions has all of the solver.
struct RunBaOptions {
  LocalBaOptions& of;
};

template <class Visitor>
void VisitFields(Visitor&& visit, RunBaOptions& o) {
  visit("robust", o.of.robust, "use the Huber loss");
}

struct MappingOptions {
  int fusion_neighbours = 10;  // keyframes searched for duplicates; no option of a run
  LandmarkCreationOptions creation;
  CleanupOptions cleanup;
  LocalBaWindowOptions window;
  LocalBaOptions ba{.function_tolerance = 1e-3};  // 1e-4 takes 1.2 times the time without gain
  bool stereo_calibration = true;
  bool lens_calibration = true;
  int final_adjustment_keyframes = 1000;
  LineMapOptions line_map;
};

template <class Visitor>
void VisitFields(Visitor&& visit, MappingOptions& o) {
  visit("cleanup", o.cleanup, "removal of weak landmarks and redundant keyframes");
  visit("window", o.window, "what local bundle adjustment adjusts");
  RunBaOptions ba{o.ba};
  visit("ba", ba, "local bundle adjustment");
  visit("stereo_calibration",
        o.stereo_calibration,
        "learn where the right image is displaced along its rows, and correct all disparities");
  visit("lens_calibration",
        o.lens_calibration,
        "one camera: learn what the calibration has left of the lens's radial distortion while the "
        "map grows and when the run ends, and adjust the whole map without it");
  visit(
      "final_adjustment_keyframes",
      o.final_adjustment_keyframes,
      "maps of up to so many keyframes are adjusted as a whole when the run ends, and larger ones "
      "whose equations take no longer, since keyframes share landmarks with those near them "
      "only; 0: none",
      Range{0, 10000});
  visit("line_map", o.line_map, "which lines of the finished map are given out");
}

// Returns the options of 0.2.0 that are constants now, with their values.
inline std::vector<RemovedOption> RemovedOptions(std::type_identity<MappingOptions>) {
  const MappingOptions o;
  return {
      FixedAt("fusion_neighbours", o.fusion_neighbours, "MappingOptions::fusion_neighbours"),
      FixedAt("creation.max_relative_depth_sigma",
              o.creation.max_relative_depth_sigma,
              "LandmarkCreationOptions::max_relative_depth_sigma"),
      FixedAt("creation.min_depth_points",
              o.creation.min_depth_points,
              "LandmarkCreationOptions::min_depth_points"),
      FixedAt("creation.max_relative_line_depth_sigma",
              o.creation.max_relative_line_depth_sigma,
              "LandmarkCreationOptions::max_relative_line_depth_sigma"),
      FixedAt("creation.neighbours", o.creation.neighbours, "LandmarkCreationOptions::neighbours"),
      FixedAt(
          "window.free_keyframes", o.window.free_keyframes, "LocalBaWindowOptions::free_keyframes"),
      FixedAt("window.fixed_keyframes",
              o.window.fixed_keyframes,
              "LocalBaWindowOptions::fixed_keyframes"),
      FixedAt("window.min_line_plane_angle_deg",
              o.window.min_line_plane_angle_deg,
              "LocalBaWindowOptions::min_line_plane_angle_deg"),
      FixedAt("window.max_line_relative_sigma",
              o.window.max_line_relative_sigma,
              "LocalBaWindowOptions::max_line_relative_sigma"),
      FixedAt(
          "window.max_pose_sigma", o.window.max_pose_sigma, "LocalBaWindowOptions::max_pose_sigma"),
      FixedAt(
          "window.max_correction", o.window.max_correction, "LocalBaWindowOptions::max_correction"),
      FixedAt("ba.rounds", o.ba.rounds, "MappingOptions::ba"),
      FixedAt("ba.max_iterations", o.ba.max_iterations, "MappingOptions::ba"),
      FixedAt("ba.function_tolerance", o.ba.function_tolerance, "MappingOptions::ba"),
      FixedAt("ba.rejection_tolerance", o.ba.rejection_tolerance, "MappingOptions::ba")};
}

}  // namespace plumbline
