// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/window_factorization.h"
#include "plumbline/initialization/window_tracks.h"
#include "plumbline/solvers/relative_pose.h"

#include <map>
#include <optional>
#include <vector>

namespace plumbline {

// When a window of frames is sure of itself.
struct WindowDecisionOptions {
  WindowFactorizationOptions factorization;
  RelativePoseOptions relative_pose;
  // Fewest matches of points and lines between the newest frame and the reference.
  int min_matches = 24;
  // Fewest points among these matches.
  int min_points = 12;
  // Least parallax of the median point of the newest frame.
  double min_parallax_deg = 1.2;
  // Least share of the matches of all views that fit.
  double min_inlier_share = 0.85;
  // By this part of its own chi2 the best explanation must be better than the next best.
  double min_margin = 0.5;
  // Largest standard deviations that the covariance may promise: of the rotation of the newest
  // pose, of the direction of the line between the centres, and of the depth of the median point,
  // relative.
  double max_rotation_deg = 0.06;
  double max_direction_deg = 0.7;
  double max_depth = 0.06;
  // Least noise that is assumed of measurements, relative to what they are said to have.
  double min_noise = 0.25;
  // With so many points lines are not asked.
  int many_points = 200;
};

struct WindowDecision {
  InitializationWait wait = InitializationWait::kNone;
  double parallax_deg = 0;  // median over the points of the newest frame; 0: unknown
  std::optional<WindowSolution> solution;
};

// The explanations of a window that could not be ruled out, for the next window of the same
// reference: what the newest frame can tell may be less than what earlier ones could.
class WindowMemory {
 public:
  void Clear() {
    explanations_.clear();
    sure_ = false;
  }
  // The best first; `sure`: it would have been accepted.
  void Keep(const WindowTracks& tracks, const std::vector<WindowSolution>& solutions, bool sure);
  bool sure() const { return sure_; }
  std::vector<WindowHypothesis> HypothesesFor(const WindowTracks& tracks) const;

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.explanations_, self.sure_);
  }

 private:
  struct Explanation {
    Rigid3 newest_from_reference;
    std::map<int, double> inverse_distances;  // by feature of the reference

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.newest_from_reference, self.inverse_distances);
    }
  };
  std::vector<Explanation> explanations_;
  bool sure_ = false;
};

// Solves a window of frames in all ways that the newest frame allows and says whether one of them
// is right beyond doubt:
//
//  - every hypothesis of the pose of the newest frame (essential matrix and homography, all their
//    decompositions), and every explanation of an earlier window, is carried through all frames
//    (FactorizeWindow) and adjusted to all matches;
//  - the best must beat every other that differs in pose by a margin of chi2 that noise does not
//    make (kAmbiguous otherwise): so the two interpretations of a plane are told apart;
//  - the first-order covariance must promise what the map is to be (kTooLittleParallax or
//    kInaccurate otherwise). A camera that stands or turns leaves depth and direction free, which
//    the covariance says; so does a small thing that moves before a camera at rest, since the
//    median is that of all points.
//
// Never tells more than the model knows: a scene most of which moves as one rigid body is taken for
// a camera that moves.
WindowDecision DecideWindow(const WindowTracks& tracks,
                            const WindowDecisionOptions& options,
                            WindowMemory& memory,
                            Rng& rng);

}  // namespace plumbline
