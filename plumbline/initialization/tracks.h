// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/klt_tracks.h"
#include "plumbline/initialization/matching.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Where one frame shows the points of the reference: ideal image coordinates (x/z, y/z).
struct TrackedPoints {
  std::vector<Eigen::Vector2d> points;  // by point of the reference
  std::vector<double> sigmas;           // standard deviation of each coordinate; 0: not matched

  bool Has(std::size_t point) const { return sigmas[point] > 0; }
  std::size_t CountSeen() const {
    return static_cast<std::size_t>(
        std::count_if(sigmas.begin(), sigmas.end(), [](double sigma) { return sigma > 0; }));
  }
};

// Where one frame shows the lines of the reference: segments in ideal image coordinates.
struct TrackedLines {
  std::vector<Segment2> segments;  // by line of the reference
  std::vector<double> sigmas;      // standard deviation of each end across the line; 0: not matched

  bool Has(std::size_t line) const { return sigmas[line] > 0; }
};

// The lines of a reference frame that at least two later frames show: two views of a line say
// nothing about the cameras, three do.
struct LineTracks {
  TrackedLines reference;           // has all
  std::vector<TrackedLines> views;  // by view; empty: there are no lines

  std::size_t size() const { return reference.segments.size(); }
};

// The points and lines of a reference frame in m later frames, as they were really matched: not all
// points are in all frames.
struct Tracks {
  TrackedPoints reference;           // has all
  std::vector<TrackedPoints> views;  // by time; the last is the newest frame
  std::vector<int> features;         // features of the reference, by point
  LineTracks lines;

  std::size_t size() const { return reference.points.size(); }
};

// Calls visit(view, tracked) for the reference (view 0) and each later view (from 1 on) that shows
// point k of Tracks or line k of LineTracks.
template <class PointsOrLines, class Visit>
void VisitViews(const PointsOrLines& tracks, std::size_t k, const Visit& visit) {
  visit(0, tracks.reference);
  for (std::size_t i = 0; i < tracks.views.size(); ++i) {
    if (tracks.views[i].Has(k)) visit(i + 1, tracks.views[i]);
  }
}

// Multiplies the standard deviations of points (Tracks) or of lines (LineTracks).
template <class PointsOrLines>
void ScaleSigmas(double factor, PointsOrLines& tracks) {
  const auto scale = [factor](auto& tracked) {
    for (double& sigma : tracked.sigmas) sigma *= factor;
  };
  scale(tracks.reference);
  for (auto& view : tracks.views) scale(view);
}

// The points that a frame shows, each with its place in the reference, in order.
std::vector<RayMatch> MatchesBetween(const TrackedPoints& reference, const TrackedPoints& view);

// Tracks features over frames: a reference frame and the frames since, matched with it. Frames are
// kept when an attempt at a map fails; beyond a limit every second one is left out. The reference
// moves forward only when matches with it die out.
class FrameWindow {
 public:
  FrameWindow(const RectifiedCamera& camera, InitialMatching matching)
      : camera_(camera), matching_(matching) {}

  void Reset();
  bool empty() const { return !reference_; }
  int size() const { return static_cast<int>(frames_.size()); }  // without the reference
  const InitializationFrame& reference() const { return *reference_; }
  const InitializationFrame& frame(int index) const {
    return frames_[static_cast<std::size_t>(index)].frame;
  }

  // Takes the next frame of a sequence, unless it has too few features, and says what is missing
  // for an attempt at a map; kNone: nothing. An attempt needs `needed` frames after the reference.
  // Where few matches with the reference are left (kTooFewMatches), the reference is another one
  // from then on.
  InitializationResult Offer(const InitializationFrame& frame, int needed);

  // The first frame becomes the reference; later ones are matched with it by descriptor and, where
  // asked for, its points followed from image to image and brought to where the image looks as in
  // the reference (klt_tracks.h, patch_alignment.h). Returns how many of them it shows.
  int Add(const InitializationFrame& frame);
  // Makes the frame halfway to the newest the reference and matches those after it anew.
  void MoveReference();

  // `count` frames spread evenly since the reference, the newest last (first paper: the subsequent
  // frames, which at video rate have not moved yet). At most size().
  std::vector<int> SelectFrames(int count) const;

  // Where the frames show the reference's points: at most `max_points` of them, spread over the
  // image, those first that the newest frame shows, then those that most frames show.
  Tracks CollectTracks(const std::vector<int>& frames, int max_points) const;

  // The features of the frames that show a point or line of the reference, which is view 0, by
  // point and line that are seen at least twice.
  std::vector<FeatureTrack> PointObservations(const std::vector<int>& frames) const;
  std::vector<FeatureTrack> LineObservations(const std::vector<int>& frames) const;

  // All that it keeps (base/byte_format.h) but for what VisitMostMatches visits: saved states have
  // that at another place.
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.reference_, self.flow_, self.warps_, self.frames_);
  }
  template <class Self, class Visitor>
  static void VisitMostMatches(Self& self, const Visitor& visit) {
    visit(self.most_matches_);
  }
  // False for a state that no window can have: places, matches and images that do not go together.
  bool IsConsistent() const;

 private:
  // Where a frame shows a feature of the reference, pixels.
  struct Place {
    Eigen::Vector2d px = Eigen::Vector2d::Zero();
    double sigma_px = 0;  // 0: not seen

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.px, self.sigma_px);
    }
  };
  struct MatchedFrame {
    InitializationFrame frame;
    ReferenceMatches matches;
    std::vector<Place> places;  // by feature of the reference

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.frame, self.matches, self.places);
    }
    TrackedPixels Pixels() const;
  };

  void SetReference(const InitializationFrame& frame);
  std::vector<Place> PlacesOfMatches(const Features& features,
                                     const ReferenceMatches& matches) const;
  std::vector<Place> PlacesOnImage(const InitializationFrame& frame,
                                   const ReferenceMatches& matches);
  std::vector<std::size_t> SelectFeatures(const std::vector<int>& frames, int count) const;
  LineTracks CollectLineTracks(const std::vector<int>& frames) const;

  RectifiedCamera camera_;
  InitialMatching matching_;
  std::optional<InitializationFrame> reference_;
  KltTracks flow_;                      // of the reference's features, by feature
  std::vector<Eigen::Matrix2d> warps_;  // of their patches in the newest frame (patch_alignment.h)
  std::vector<MatchedFrame> frames_;
  int most_matches_ = 0;  // of a frame with the present reference
};

}  // namespace plumbline
