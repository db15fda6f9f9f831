// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/parallel.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/klt_tracks.h"
#include "plumbline/initialization/matching.h"
#include "plumbline/matching/projection_search.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The points of the reference in one frame, in ideal image coordinates (x/z, y/z).
struct ViewPoints {
  std::vector<Eigen::Vector2d> points;  // one position for each point of the reference
  // Standard deviation of each coordinate; 0 if the point was not matched.
  std::vector<double> sigmas;

  bool Has(std::size_t point) const { return sigmas[point] > 0; }
  std::size_t CountSeen() const {
    return static_cast<std::size_t>(
        std::count_if(sigmas.begin(), sigmas.end(), [](double sigma) { return sigma > 0; }));
  }
};

// The lines of the reference in one frame, as segments in ideal image coordinates.
struct ViewLines {
  std::vector<Segment2> segments;  // one segment for each line of the reference
  // Standard deviation of each end across the line; 0 if the line was not matched.
  std::vector<double> sigmas;

  bool Has(std::size_t line) const { return sigmas[line] > 0; }
};

// The lines of a reference frame visible in at least two later frames. Two views of a line do not
// constrain the cameras, three do.
struct LineTracks {
  ViewLines reference;           // shows all lines
  std::vector<ViewLines> views;  // empty if there are no lines

  std::size_t size() const { return reference.segments.size(); }
};

// The points and lines of a reference frame in m later frames, as far as matched: not every frame
// shows every point.
struct FeatureTracks {
  ViewPoints reference;           // shows all points
  std::vector<ViewPoints> views;  // in order of time; the last is the newest frame
  std::vector<int> features;      // feature of the reference for each point
  LineTracks lines;

  std::size_t size() const { return reference.points.size(); }
};

// Calls visit(view, tracked) for each view that shows point k of FeatureTracks or line k of
// LineTracks: the reference (view 0) and later views (from 1 on).
template <class PointsOrLines, class Visit>
void VisitViews(const PointsOrLines& tracks, std::size_t k, const Visit& visit) {
  visit(0, tracks.reference);
  for (std::size_t i = 0; i < tracks.views.size(); ++i) {
    if (tracks.views[i].Has(k)) visit(i + 1, tracks.views[i]);
  }
}

// Multiplies the standard deviations of points (FeatureTracks) or of lines (LineTracks).
template <class PointsOrLines>
void ScaleSigmas(double factor, PointsOrLines& tracks) {
  const auto scale = [factor](auto& tracked) {
    for (double& sigma : tracked.sigmas) sigma *= factor;
  };
  scale(tracks.reference);
  for (auto& view : tracks.views) scale(view);
}

// Returns the points visible in a frame, each with its position in the reference, in order.
std::vector<RayMatch> MatchesBetween(const ViewPoints& reference, const ViewPoints& view);

// Feature tracks over frames: a reference frame, and the later frames matched with it. Frames are
// kept when an attempt at a map fails; beyond a limit every second one is dropped. The reference
// moves forward only if matches with it become too few.
class InitializationWindow {
 public:
  // The helper shares the work on images, with the same result; it must outlive the window.
  InitializationWindow(const CameraAndPyramid& imaging,
                       InitialMatching matching,
                       HelperThread* helper = nullptr)
      : camera_(imaging.camera),
        octave_scale_(imaging.octave_scale),
        matching_(matching),
        helper_(helper) {}

  void Reset();
  bool empty() const { return !reference_; }
  // Number of frames without the reference.
  int size() const { return static_cast<int>(frames_.size()); }
  const InitializationFrame& reference() const { return *reference_; }
  const InitializationFrame& frame(int index) const {
    return frames_[static_cast<std::size_t>(index)].frame;
  }

  // Takes the next frame of a sequence, unless it has too few features. Returns the condition
  // missing for an attempt at a map, which needs `needed` frames after the reference; kNone if none
  // is missing. If few matches with the reference are left (kTooFewMatches), another frame is the
  // reference from then on.
  InitializationResult Offer(const InitializationFrame& frame, int needed);

  // Adds a frame and returns its number of matches with points of the reference. The first frame
  // becomes the reference. Later frames are matched with it by descriptor; with
  // InitialMatching::kImages, its points are tracked from image to image and aligned to their
  // appearance in the reference (klt_tracks.h, patch_alignment.h).
  int Add(const InitializationFrame& frame);
  // Makes the frame halfway to the newest one the reference, and matches the frames after it again.
  void MoveReference();

  // Returns at most `count` frames spread evenly since the reference, the newest last. The first
  // paper takes the frames directly after the reference, which at video rate have not moved yet.
  std::vector<int> SelectFrames(int count) const;
  // Returns the `count` newest, successive frames, the newest last, as in the first paper.
  std::vector<int> NewestFrames(int count) const;
  // Returns true if points are tracked and aligned on images.
  bool FollowsImages() const { return matching_ == InitialMatching::kImages; }

  // Returns the positions of the reference's points in the frames. At most `max_points` points,
  // spread over the image, are taken: first those visible in the newest frame, then those visible
  // in most frames.
  FeatureTracks CollectTracks(const std::vector<int>& frames, int max_points) const;

  // Returns the tracks of the points or lines visible in at least two views: for each, its features
  // in the frames. The reference is view 0.
  std::vector<FeatureTrack> PointObservations(const std::vector<int>& frames) const;
  std::vector<FeatureTrack> LineObservations(const std::vector<int>& frames) const;

 private:
  // Pixel of a feature of the reference in a frame.
  struct Place {
    Eigen::Vector2d px = Eigen::Vector2d::Zero();
    double sigma_px = 0;  // 0: not seen
  };
  struct MatchedFrame {
    InitializationFrame frame;
    ReferenceMatches matches;
    std::vector<Place> places;  // one for each feature of the reference
    TrackedPixels Pixels() const;
  };

  void SetReference(const InitializationFrame& frame);
  std::vector<Place> PlacesOfMatches(const Features& features,
                                     const ReferenceMatches& matches) const;
  std::vector<Place> PlacesOnImage(const InitializationFrame& frame,
                                   const ReferenceMatches& matches);
  TrackedPixels AlignWithReference(const GrayImage& image,
                                   const TrackedPixels& guesses,
                                   const Eigen::Matrix2d& linear);
  std::vector<std::size_t> SelectFeatures(const std::vector<int>& frames, int count) const;
  LineTracks CollectLineTracks(const std::vector<int>& frames) const;

  RectifiedCamera camera_;
  double octave_scale_;
  InitialMatching matching_;
  HelperThread* helper_;
  std::optional<InitializationFrame> reference_;
  // Follows the reference's features, one point for each feature.
  KltTracks flow_;
  // Warps of their patches in the newest frame (patch_alignment.h).
  std::vector<Eigen::Matrix2d> warps_;
  std::vector<MatchedFrame> frames_;
  // Largest number of matches of a frame with the current reference.
  int most_matches_ = 0;
};

}  // namespace plumbline
