// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/frustum_tree.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/matching/projection_search.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Index of segments of an image by position and direction. Each cell of a coarse grid, and each
// range of directions, has a set of segments, with one bit for each segment.
class SegmentIndex {
 public:
  // An empty index for `count` segments of an image of width x height pixels.
  SegmentIndex(int width, int height, std::size_t count);

  void Add(std::size_t index, const Segment2& segment);
  // Removes a segment from later searches.
  void Remove(std::size_t index) { At(open_, 0, index / kBits) &= ~Bit(index); }

  // Calls visit(index), ascending, for all segments whose bounding box meets `box` and whose
  // direction is within 18.2 degrees (a cosine of 0.95) of the unit vector. It is also called for
  // some other segments.
  template <class Visit>
  void ForEachNear(const Eigen::AlignedBox2d& box,
                   const Eigen::Vector2d& direction,
                   const Visit& visit) const {
    const Range columns = Columns(box), rows = Rows(box);
    const Range directions = DirectionsAround(direction);
    for (std::size_t word = 0; word < words_; ++word) {
      std::uint64_t near = 0, parallel = 0;
      for (int row = rows.first; row <= rows.last; ++row) {
        for (int column = columns.first; column <= columns.last; ++column) {
          near |= At(cells_, row * kColumns + column, word);
        }
      }
      for (int k = directions.first; k <= directions.last; ++k) {
        parallel |= At(directions_, (k + kDirections) % kDirections, word);
      }
      for (std::uint64_t bits = near & parallel & At(open_, 0, word); bits != 0; bits &= bits - 1) {
        visit(word * kBits + static_cast<std::size_t>(std::countr_zero(bits)));
      }
    }
  }

 private:
  static constexpr int kColumns = 16, kRows = 8, kDirections = 16;
  static constexpr std::size_t kBits = 64;
  struct Range {
    int first = 0, last = 0;
  };

  static std::uint64_t Bit(std::size_t index) { return std::uint64_t{1} << (index % kBits); }
  std::uint64_t& At(std::vector<std::uint64_t>& bits, int set, std::size_t word) const {
    return bits[static_cast<std::size_t>(set) * words_ + word];
  }
  std::uint64_t At(const std::vector<std::uint64_t>& bits, int set, std::size_t word) const {
    return bits[static_cast<std::size_t>(set) * words_ + word];
  }
  static int DirectionOf(double angle);
  static Range DirectionsAround(const Eigen::Vector2d& direction);
  static Range Cells(double first, double last, double cell, int count);
  Range Columns(const Eigen::AlignedBox2d& box) const;
  Range Rows(const Eigen::AlignedBox2d& box) const;

  Eigen::Vector2d cell_;                           // size of a cell, pixels
  std::size_t words_ = 0;                          // number of words in each set
  std::vector<std::uint64_t> cells_, directions_;  // sets of segments
  std::vector<std::uint64_t> open_;                // one set: the segments not removed
};

// Hypothesis of a line of the world, with interval and information.
struct LineHypothesis {
  PluckerLine line;
  LineInterval interval;                                  // start < end
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();  // information of the orthonormal tangent
  // Largest distance of a keyframe from the middle of the interval for it to be searched.
  double reach = std::numeric_limits<double>::infinity();
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
