// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/helper_thread.h"
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
  std::vector<Eigen::Vector2d> points;  // one place for each point of the reference
  // Standard deviation of each coordinate; 0 where the point was not matched.
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
  // Standard deviation of each end across the line; 0 where the line was not matched.
  std::vector<double> sigmas;

  bool Has(std::size_t line) const { return sigmas[line] > 0; }
};

// The lines of a reference frame that at least two later frames show. Two views of a line say
// nothing about the cameras, three do.
struct LineTracks {
  ViewLines reference;           // shows all lines
  std::vector<ViewLines> views;  // empty where there are no lines

  std::size_t size() const { return reference.segments.size(); }
};

// The points and lines of a reference frame in m later frames, only as far as they were matched:
// not every frame shows every point.
struct FeatureTracks {
  ViewPoints reference;           // shows all points
  std::vector<ViewPoints> views;  // in order of time; the last is the newest frame
  std::vector<int> features;      // feature of the reference for each point
  LineTracks lines;

  std::size_t size() const { return reference.points.size(); }
};

// Calls visit(view, tracked) for the reference (view 0) and each later view (from 1 on) that shows
// point k of FeatureTracks or line k of LineTracks.
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

// Returns the points that a frame shows, each with its place in the reference, in order.
std::vector<RayMatch> MatchesBetween(const ViewPoints& reference, const ViewPoints& view);

// FeatureTracks features over frames: a reference frame, and the frames since, matched with it.
// Frames are kept when an attempt at a map fails; beyond a limit every second one is dropped. The
// reference moves forward only when matches with it die out.
class InitializationWindow {
 public:
  // The helper shares the work on images, with the same result; it has to outlive the window.
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

  // Takes the next frame of a sequence, unless it has too few features. The result says what is
  // missing for an attempt at a map, which needs `needed` frames after the reference; kNone when
  // nothing is missing. Where few matches with the reference are left (kTooFewMatches), another
  // frame is the reference from then on.
  InitializationResult Offer(const InitializationFrame& frame, int needed);

  // Adds a frame and returns how many points of the reference it shows. The first frame becomes the
  // reference. Later frames are matched with it by descriptor; where asked for, its points are
  // followed from image to image and brought to where the image looks as in the reference
  // (klt_tracks.h, patch_alignment.h).
  int Add(const InitializationFrame& frame);
  // Makes the frame halfway to the newest one the reference, and matches the frames after it anew.
  void MoveReference();

  // Returns at most `count` frames spread evenly since the reference, the newest last. The first
  // paper takes the frames that follow the reference, which at video rate have not moved yet.
  std::vector<int> SelectFrames(int count) const;
  // Returns the `count` newest frames, which follow each other, the newest last: those of the first
  // paper.
  std::vector<int> NewestFrames(int count) const;
  // Whether points are followed and aligned on images.
  bool FollowsImages() const { return matching_ == InitialMatching::kImages; }

  // Returns the places of the reference's points in the frames. At most `max_points` points, spread
  // over the image, are taken: first those that the newest frame shows, then those that most frames
  // show.
  FeatureTracks CollectTracks(const std::vector<int>& frames, int max_points) const;

  // Returns the tracks of the points or lines that at least two views show: for each, the features
  // of the frames that show it. The reference is view 0.
  std::vector<FeatureTrack> PointObservations(const std::vector<int>& frames) const;
  std::vector<FeatureTrack> LineObservations(const std::vector<int>& frames) const;

 private:
  // The pixel where a frame shows a feature of the reference.
  struct Place {
    Eigen::Vector2d px = Eigen::Vector2d::Zero();
    double sigma_px = 0;  // 0: not seen
  };
  struct MatchedFrame {
    InitializationFrame frame;
    ReferenceMatches matches;
    std::vector<Place> places;  // one place for each feature of the reference
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
  // Most matches that a frame had with the present reference.
  int most_matches_ = 0;
};

}  // namespace plumbline
