// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/matching.h"
#include "plumbline/initialization/tracks.h"
#include "plumbline/solvers/relative_pose.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// How well a model of two views explains matches (Mur-Artal, Montiel and Tardos, "ORB-SLAM", 2015,
// section IV): the sum of 5.99 - d^2 over both images of all matches, where d^2, the squared
// distance over its variance, is below 3.84 (distance from the epipolar line) or 5.99 (from the
// mapped point).
double EpipolarScore(const Eigen::Matrix3d& essential, std::span<const RayMatch> matches);
double TransferScore(const Eigen::Matrix3d& homography, std::span<const RayMatch> matches);

enum class TwoViewModel { kEssential, kHomography };

struct TwoViewSolution {
  InitializationWait wait = InitializationWait::kNone;  // kNone: the pose can be used
  TwoViewModel model = TwoViewModel::kEssential;
  Rigid3 b_from_a;            // |translation| = 1; of the best motion also where it is not good
  std::vector<bool> is_good;  // by match: in front of both, agrees with both
  double parallax_deg = 0;    // median over the good ones, after rotation
};

// The relative pose as the ORB-SLAM paper decides it (section IV): essential matrix and homography
// by RANSAC, the homography where its share of the two scores is above 0.45, all motions of the
// chosen one, and of these the one with most points that lie in front and agree with both views -
// if it has enough of them, parallax, and no rival.
//
// Differs from the paper: the essential matrix in place of the fundamental one, since the camera is
// calibrated; adaptive numbers of samples and least squares on the inliers (ransac.h).
//
//   fails  wait says why: kTooFewMatches, kAmbiguous (a rival with 0.75 of the points),
//          kTooLittleParallax (median below 1 degree), kInaccurate (too few good points)
//   cost   some milliseconds
TwoViewSolution SolveTwoViews(std::span<const RayMatch> matches, Rng& rng);

// The conventional start: the first frame with enough features is the reference until a later one
// gives a pose (SolveTwoViews) and a map after bundle adjustment. A frame with too few matches
// becomes the new reference, and what was seen before is forgotten.
class TwoViewInitializer : public Initializer {
 public:
  TwoViewInitializer(const RectifiedCamera& camera, std::uint64_t seed)
      : camera_(camera), seed_(seed) {}

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override;
  void Save(StateWriter& archive) const override;
  void Load(StateReader& archive) override;

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.reference_, self.motion_);
  }

 private:
  RectifiedCamera camera_;
  std::uint64_t seed_;
  std::optional<InitializationFrame> reference_;
  ImageMotion motion_;  // from the reference to the newest frame
};

// The conventional decision (SolveTwoViews) on what rank1 sees: points are followed and aligned on
// the images (FrameWindow), and the reference stays until matches with it die out. Beside rank1 it
// tells what factorization and the decision of several frames bring, beside two_view what the
// matches bring.
//
// Each frame is tried alone, with all points that it shows of the reference. Needs the images of
// all frames (BugError otherwise).
class TwoViewImagesInitializer : public Initializer {
 public:
  TwoViewImagesInitializer(const RectifiedCamera& camera, std::uint64_t seed)
      : camera_(camera), seed_(seed), window_(camera, InitialMatching::kImages) {}

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override { window_.Reset(); }
  void Save(StateWriter& archive) const override;
  void Load(StateReader& archive) override;

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.window_);
    FrameWindow::VisitMostMatches(self.window_, visit);
  }

 private:
  RectifiedCamera camera_;
  std::uint64_t seed_;
  FrameWindow window_;
};

}  // namespace plumbline
