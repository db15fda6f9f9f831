// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/problem.h"

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace plumbline {

// Keyframes and landmarks of a map as a plain problem, and the ids of its indices. The problem's
// world is the camera of a keyframe, since lines far from the origin are ill conditioned.
struct MapProblem {
  BaProblem problem;
  Rigid3 problem_from_world;
  std::vector<KeyFrameId> keyframes;  // keyframe of each pose index
  std::vector<PointId> points;        // point of each point index
};

// Fills a MapProblem. All poses must be added before their landmarks.
class MapProblemBuilder {
 public:
  // An observation by a keyframe that has a pose in the problem.
  struct View {
    int pose = 0;
    std::size_t feature = 0;
  };

  // The world of the problem is the camera of `origin`. `out` must be empty; `map` and `out` must
  // outlive the builder.
  MapProblemBuilder(const Map& map,
                    const CameraAndPyramid& imaging,
                    const LineWeights& weights,
                    KeyFrameId origin,
                    MapProblem& out);

  void AddPose(KeyFrameId id, bool fixed);

  // Returns the views of a landmark, ordered by keyframe. Valid until the next call.
  const std::vector<View>& ViewsOf(const Observations& observations);

  // Adds a point with its views; skips points with fewer than two views.
  void AddPoint(const MapPoint& point);
  // Adds a line without views and returns its index.
  int AddLine(const PluckerLine& in_world);
  // Adds the ends of the newest line.
  void AddEnds(const Segment3& in_world);
  // Adds the segment in the left image to a line; with `with_right` also that in the right image,
  // if any.
  void AddLineView(int line, const View& view, bool with_right);

  // Returns the index of the pose of a keyframe; kNoPose if it has none.
  static constexpr int kNoPose = -1;
  int PoseOf(KeyFrameId id) const { return pose_of_[static_cast<std::size_t>(id.value)]; }

 private:
  bool Follows(KeyFrameId before, KeyFrameId id) const;
  const Features& FeaturesOf(const View& view) const {
    return frames_[static_cast<std::size_t>(view.pose)]->features();
  }

  const Map& map_;
  LineWeights weights_;
  MapProblem& out_;
  Rigid3 world_from_problem_;
  std::vector<int> pose_of_;          // index by keyframe id
  std::vector<const Frame*> frames_;  // frame of each pose
  std::vector<View> views_;           // result of the last ViewsOf
};

// Returns the removals of the outlier observations of points.
std::vector<edit::RemovePointObservation> OutliersOf(const MapProblem& part,
                                                     const BaResult& result);

// Returns the poses of the result in the world of the map, including fixed poses.
std::map<KeyFrameId, Rigid3> PosesByKeyFrame(const MapProblem& part, const BaResult& result);

// Returns the result as changes of the map: free poses, points, and the removal of outlier
// observations of points. Lines are up to the caller.
MapEdit PosesAndPointsOf(const MapProblem& part, const BaResult& result);

// Returns for each pose the factor by which a solution has changed the depths of its points, as the
// median over these points; 1 if depth is measured. A pose with fewer than ten points in front of
// it gets the factor of the pose before it; the first ones get that of the first pose with enough.
std::vector<double> ScalesOf(const BaProblem& problem, const BaResult& result);

// Scales a solution for a single camera about the camera of its first pose, so that the median
// depth of this pose's points is unchanged. Does nothing if depth is measured, or if two or more
// poses are fixed, which fix the scale. Otherwise no measurement fixes it, and the damped steps of
// an adjustment change it: a map of twenty keyframes grew by two thirds within a second of forward
// motion, and earlier reported poses were inconsistent with all later ones.
void FixScaleToOldestKeyFrame(const BaProblem& problem, BaResult& result);

// Moves a solution for a single camera as a whole, poses, points and lines, so that one of its
// poses is unchanged, and scales it so that the median depth of this pose's points is unchanged. If
// it is the newest one, later reported poses continue the earlier ones without a step. Does nothing
// if depth is measured.
void KeepPlaceOf(std::size_t pose, const BaProblem& problem, BaResult& result);

// Returns the change that moves a map line. The interval follows from the observed segments, each
// trimmed to the new line. With four or more views the outermost ends are dropped, since one view's
// overlong segment should not lengthen the line for ever. The information follows from all
// observations. The direction keeps its sense.
//   poses  keyframe poses that differ from the map's
//   kept   the ends, where the line keeps its own: the interval reaches from one to the other
edit::MoveLine RefitInterval(const Map& map,
                             const CameraAndPyramid& imaging,
                             const std::map<KeyFrameId, Rigid3>& poses,
                             const MapLine& line,
                             const PluckerLine& moved,
                             const std::optional<Segment3>& kept = std::nullopt);

}  // namespace plumbline
