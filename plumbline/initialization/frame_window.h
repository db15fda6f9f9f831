// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/klt_tracks.h"
#include "plumbline/initialization/matching.h"
#include "plumbline/initialization/structure.h"
#include "plumbline/initialization/window_tracks.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

// A reference frame and the frames since, matched with it. Frames are kept when an attempt at a map
// fails; beyond a limit every second one is left out.
class FrameWindow {
 public:
  FrameWindow(const RectifiedCamera& camera, InitialMatching matching)
      : camera_(camera), matching_(matching) {}

  void Reset();
  bool empty() const { return !reference_; }
  int size() const { return static_cast<int>(frames_.size()); }  // without the reference
  const InitializationFrame& reference() const { return *reference_; }

  // The first frame becomes the reference; later ones are matched with it by descriptor and, where
  // asked for, its points followed from image to image and brought to where the image looks as in
  // the reference (klt_tracks.h, match_refinement.h). Returns how many of them it shows.
  int Add(const InitializationFrame& frame);
  // Makes the frame halfway to the newest the reference and matches those after it anew.
  void MoveReference();

  // `count` frames spread evenly since the reference, the newest last (first paper: the subsequent
  // frames, which at video rate have not moved yet). At most size().
  std::vector<int> Spread(int count) const;

  // What the frames show of the reference's points: at most `max_points` of them, spread over the
  // image, those first that the newest frame shows, then those that most frames show.
  WindowTracks TracksOf(const std::vector<int>& frames, int max_points) const;

  // The tracks as features of views, the reference being view 0: points and lines seen at least
  // twice.
  std::vector<FeatureTrack> PointTracks(const std::vector<int>& frames) const;
  std::vector<FeatureTrack> LineTracks(const std::vector<int>& frames) const;
  const InitializationFrame& frame(int index) const {
    return frames_[static_cast<std::size_t>(index)].frame;
  }

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.reference_, self.flow_, self.warps_, self.frames_);
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
  struct Matched {
    InitializationFrame frame;
    ReferenceMatches matches;
    std::vector<Place> places;  // by feature of the reference

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.frame, self.matches, self.places);
    }
  };

  WindowLines LinesOf(const std::vector<int>& frames) const;
  static std::vector<std::optional<Eigen::Vector2d>> PlacesOf(const Matched& matched);
  void SetReference(const InitializationFrame& frame);
  std::vector<Place> PlacesOfMatches(const Features& features,
                                     const ReferenceMatches& matches) const;
  std::vector<Place> PlacesOnImage(const InitializationFrame& frame,
                                   const ReferenceMatches& matches);
  std::vector<std::size_t> SpreadFeatures(const std::vector<int>& frames, int count) const;

  RectifiedCamera camera_;
  InitialMatching matching_;
  std::optional<InitializationFrame> reference_;
  KltTracks flow_;  // optical flow of the reference's features, by feature
  std::vector<Eigen::Matrix2d>
      warps_;  // affine maps of their patches in the newest frame (match_refinement.h)
  std::vector<Matched> frames_;
};

}  // namespace plumbline
