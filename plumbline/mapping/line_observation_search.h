// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/frustum_tree.h"
#include "plumbline/mapping/segment_index.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/matching/uncertain_line.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Hypothesis of a line of the world, with interval and information.
struct LineHypothesis {
  PluckerLine line;
  LineInterval interval;                                  // start < end
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();  // information of the orthonormal tangent
};

// A line feature of a keyframe that matches the projection of a line of the world.
struct LineSupport {
  const KeyFrame* keyframe = nullptr;
  std::size_t feature = 0;
  bool right = false;  // true if its segment in the right image matches as well

  friend bool operator==(const LineSupport&, const LineSupport&) = default;
};

// Finds the segments of all keyframes that show a line, whatever landmark they were matched with.
// Each segment belongs to at most one line: claimed segments are not found again.
class LineSupportSearch {
 public:
  // The map and `imaging` must outlive the search.
  LineSupportSearch(const Map& map, const CameraAndPyramid& imaging);

  // Returns the segments of a line, ordered by keyframe. They have the line's direction (bright
  // side on the same side) and overlap its interval by a quarter of the shorter of the two. Both
  // ends are within 10 px of the projected line, and within chi2 99 % of it, given the deviations
  // of the segment, the poses and the line. O(keyframes that may have the line in their image +
  // features near it there).
  std::vector<LineSupport> Find(const LineHypothesis& hypothesis) const;

  void Claim(std::span<const LineSupport> supports);

  const FrustumTree& views() const { return views_; }

 private:
  // `uncertain` is the line of the hypothesis.
  std::optional<LineSupport> Test(const LineHypothesis& hypothesis,
                                  const UncertainLine& uncertain,
                                  const KeyFrame& keyframe,
                                  std::size_t feature) const;

  const CameraAndPyramid& imaging_;
  FrustumTree views_;
  std::vector<SegmentIndex> segments_;  // segments not claimed yet, by index in views_
};

// Counts the keyframes among supports in the order of Find.
int CountKeyFrames(std::span<const LineSupport> supports);

// Triangulates the line through all supports, left and right segments alike (TriangulateLine).
// Returns nullopt if that fails. The interval of the line is not set.
std::optional<LineHypothesis> LineThroughSupports(const RectifiedCamera& camera,
                                                  std::span<const LineSupport> supports);

// Returns the parts of a line, as parameters along it, shown by at least `min_keyframes` keyframes
// and by at least `min_share` of the supporting keyframes that have them in their image. Each
// segment is trimmed to the line (eq. 30). Gaps of up to a tenth of the whole are closed.
std::vector<LineInterval> ShownParts(const RectifiedCamera& camera,
                                     const PluckerLine& line,
                                     std::span<const LineSupport> supports,
                                     int min_keyframes,
                                     double min_share);

// Returns the part of a line inside an image, as parameters along it; nullopt if the line misses
// the image.
std::optional<Stretch> PartInImage(const RectifiedCamera& camera,
                                   const Rigid3& cam_from_world,
                                   const PluckerLine& line);

// Returns the length of the overlap of two intervals, over that of the shorter one.
double OverlapRatio(const LineInterval& a, const LineInterval& b);

}  // namespace plumbline
