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
  int min_matches = 24;            // of the newest frame with the reference: points and lines ...
  int min_points = 12;             // ... and of them points
  double min_parallax_deg = 1.2;   // of the median point of the newest frame
  double min_inlier_share = 0.85;  // of all matches of all views
  double min_margin = 0.5;         // of chi2 to the next best explanation, of its own
  double max_rotation_deg = 0.06;  // standard deviations promised for the newest pose ...
  double max_direction_deg = 0.7;  // ... of the line of the centres ...
  double max_depth = 0.06;         // ... and, relative, for the depth of the median point
  double min_noise = 0.25;         // of what measurements are said to have, at least
  int many_points = 200;           // with so many, lines are not asked
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
