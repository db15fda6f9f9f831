// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/mapping/line_map_options.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/pose_uncertainty.h"

#include <array>
#include <type_traits>

namespace plumbline {

struct LandmarkCreationOptions {
  // Largest deviation, relative to the depth, of points made from one stereo or RGB-D frame.
  double max_relative_depth_sigma = 0.04;
  // With fewer such points than this, the most certain others are made, too.
  int min_depth_points = 100;
  // Largest deviation, relative to the depth, of the ends of lines made from one frame.
  double max_relative_line_depth_sigma = 0.107;
  // Number of keyframes searched for a second view of a point.
  int neighbours = 6;
};

template <class Visitor>
void VisitFields(Visitor&& visit, LandmarkCreationOptions& o) {
  visit("max_relative_depth_sigma",
        o.max_relative_depth_sigma,
        "depth uncertainty of points from one frame, relative to depth",
        Range{0.001, 1});
  visit("min_depth_points",
        o.min_depth_points,
        "points with depth that a keyframe should show, if need be less well known ones",
        Range{0, 10000});
  visit("max_relative_line_depth_sigma",
        o.max_relative_line_depth_sigma,
        "depth uncertainty of the ends of lines from one frame, relative to depth",
        Range{0.001, 1});
  visit("neighbours",
        o.neighbours,
        "closest keyframes searched for a second view of points without landmark",
        Range{0, 100});
}

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

struct LocalBaWindowOptions {
  // Number of adjusted keyframes, closest in covisibility.
  int free_keyframes = 12;
  // Largest number of fixed keyframes, which see the same landmarks and fix the window.
  int fixed_keyframes = 20;
  // Least angle between the views of a line in the window, unless its ends are certain.
  double min_line_plane_angle_deg = 10;
  // Largest deviation of certain ends, relative to their depth.
  double max_line_relative_sigma = 0.05;
  // Largest uncertainty of an adjusted keyframe's pose (PoseUncertainty).
  double max_pose_sigma = 0.01;
  // Largest correction of a keyframe relative to the one before, in one window.
  double max_correction = 0.03;
  bool parallel_lines = true;  // true: lines keep to directions shared by many lines of the map

  PoseLimits local_limits() const { return {.sigma = max_pose_sigma, .change = max_correction}; }
  PoseLimits whole_map_limits() const {
    return {.sigma = max_pose_sigma, .change = max_pose_sigma};
  }
};

template <class Visitor>
void VisitFields(Visitor&& visit, LocalBaWindowOptions& o) {
  visit("free_keyframes", o.free_keyframes, "keyframes adjusted together", Range{1, 200});
  visit("fixed_keyframes", o.fixed_keyframes, "keyframes that hold the window", Range{0, 1000});
  visit("min_line_plane_angle_deg",
        o.min_line_plane_angle_deg,
        "angle between interpretation planes from which a line is adjusted [deg]",
        Range{0, 90});
  visit("max_line_relative_sigma",
        o.max_line_relative_sigma,
        "or from this uncertainty of its ends, relative to their depth",
        Range{0, 1});
  visit(
      "max_pose_sigma",
      o.max_pose_sigma,
      "deviation to which its landmarks must fix a keyframe that is adjusted: rotation [rad] and "
      "translation relative to their depth; when the run ends, two that follow each other may not "
      "be moved against one another by more",
      Range{1e-6, 10});
  visit("max_correction",
        o.max_correction,
        "of a keyframe against the one before it, in local adjustment: rotation [rad] and "
        "translation relative to the depth of its landmarks",
        Range{1e-6, 10});
  visit("parallel_lines",
        o.parallel_lines,
        "lines that are parallel to many others of the map by chi2 are held so");
}

struct MappingOptions {
  int fusion_neighbours = 10;
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
  visit(
      "fusion_neighbours", o.fusion_neighbours, "keyframes searched for duplicates", Range{0, 100});
  visit("creation", o.creation, "new landmarks");
  visit("cleanup", o.cleanup, "removal of weak landmarks and redundant keyframes");
  visit("window", o.window, "what local bundle adjustment adjusts");
  visit("ba", o.ba, "local bundle adjustment");
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

}  // namespace plumbline
