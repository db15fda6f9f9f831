// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/measurements.h"
#include "plumbline/association/projection_search.h"
#include "plumbline/base/options.h"
#include "plumbline/cutting/cut_lines.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/map.h"
#include "plumbline/tracking/options.h"
#include "plumbline/tracking/pose_search.h"

#include <optional>
#include <vector>

namespace plumbline {

struct RelocalizationOptions {
  bool enabled = true;
  int max_keyframes = 200;  // compared in one attempt
  int min_inliers = 30;     // points + lines that must agree with the pose
  int patience = 200;       // lost frames in a map of an earlier run after which a new one starts
};

template <class Visitor>
void VisitFields(Visitor&& visit, RelocalizationOptions& o) {
  visit("enabled", o.enabled, "look for a lost camera in the map by what it shows");
  visit("max_keyframes",
        o.max_keyframes,
        "keyframes that one attempt compares the image with; a larger map takes several attempts",
        Range{1, 100000});
  visit("min_inliers",
        o.min_inliers,
        "points + lines that must agree with a pose found this way",
        Range{10, 100000});
  visit("patience",
        o.patience,
        "frames lost in the map of an earlier run after which a new map starts",
        Range{1, 1000000});
}

// A frame whose place in the map was found by its looks.
struct Relocalized {
  Frame frame;  // with its pose
  FrameAssociation association;
  KeyFrameId keyframe;  // that showed the way
  FrameCounts counts;
  double scene_depth = 0;  // median depth of what agrees with the pose

  int Inliers() const { return counts.inlier_points + counts.inlier_lines; }
};

// Finds the pose of a frame in a map by appearance alone.
//
// The keyframes to compare with are spread evenly over the map, and an attempt takes those between
// the ones that the attempt before took. They are ranked by the number of the frame's strongest
// points and lines that have a clear partner among their landmarks. From each of the best few: a
// pose that most matches agree with (AP3P), then the landmarks around that keyframe searched from
// there. Where two places explain the image nearly as well, neither is believed.
//
// Thread-safe; the result depends on the arguments alone. Cost: some tenths of a second for 200
// keyframes.
class Relocalizer {
 public:
  Relocalizer(const ImagingModel& imaging,
              const TrackingOptions& tracking,
              const LineOptions& lines,
              const CuttingOptions& cutting,
              const RelocalizationOptions& options);

  // `attempt` counts from 0; the frame's pose and matches are not looked at.
  std::optional<Relocalized> Find(const Map& map, const Frame& frame, int attempt) const;

 private:
  std::vector<KeyFrameId> MostAlike(const Map& map, const Frame& frame, int attempt) const;
  std::optional<Relocalized> FindBeside(const Map& map, const Frame& frame, KeyFrameId id) const;

  RelocalizationOptions options_;
  PoseSearch search_;
};

}  // namespace plumbline
