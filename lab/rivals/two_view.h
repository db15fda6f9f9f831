// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
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

// Returns the score of a two-view model for matches (Mur-Artal, Montiel and Tardos, "ORB-SLAM",
// 2015, section IV): the sum of 5.99 - d^2 over both images of all matches, where d is the distance
// over its deviation. Only d^2 below 3.84 counts for the distance from the epipolar line, and below
// 5.99 for the distance from the mapped point.
double EpipolarScore(const Eigen::Matrix3d& fundamental, std::span<const RayMatch> matches);
double TransferScore(const Eigen::Matrix3d& homography, std::span<const RayMatch> matches);

// Relation of two views; the fundamental matrix is that of rays (x/z, y/z).
enum class TwoViewModel { kFundamental, kHomography };

struct TwoViewSolution {
  InitializationStatus wait = InitializationStatus::kNone;  // kNone: the pose is usable
  TwoViewModel model = TwoViewModel::kFundamental;
  // Pose with |translation| = 1. It is that of the best motion, even if the solution is not good.
  Rigid3 b_from_a;
  // For each match, true if its point is in front of both views and agrees with both.
  std::vector<bool> is_good;
  // Angle that the rays of 50 good matches exceed, without the rotation.
  double parallax_deg = 0;
};

// Estimates the relative pose as in the ORB-SLAM paper (section IV): 200 random sets of eight
// matches, of each set a fundamental matrix (normalized eight points) and a homography (normalized
// DLT), the best of each by its score, and the homography if its share of the two scores is above
// 0.45. Of all motions of the chosen model, the result is that with most points in front of and
// consistent with both views, if it has enough of them, parallax, and no rival.
//
//   pixel  deviation of each coordinate in both images: a pixel, over the focal length. Those of
//          the matches are not used, as in the paper, which treats all octaves alike
//
// Differs from the paper: the homography uses all eight matches, in the paper four: with four,
// noise makes it lose planes to the fundamental matrix. Rays of the calibrated camera replace
// pixels, which is equivalent for square pixels, and makes the fundamental matrix an essential one
// but for its singular values; a point agrees by its Sampson distance, which to first order is the
// reprojection error of the best point, and is not triangulated.
//
//   fails  `wait` is the reason: kTooFewMatches, kAmbiguous (a rival with 0.7 of the points, with
//          0.75 for a homography), kTooLittleParallax (fewer than 50 points reach a degree),
//          kInaccurate (fewer than 50 good points, or than 0.9 of the inliers of the model)
//   cost   some milliseconds
TwoViewSolution SolveTwoViews(std::span<const RayMatch> matches, double pixel, Rng& rng);

// Two-view initialization: the first frame with enough features is the reference until a later one
// gives a pose (SolveTwoViews) and a map after bundle adjustment. A frame with too few matches
// becomes the new reference, and earlier frames are discarded.
class TwoViewInitializer : public Initializer {
 public:
  TwoViewInitializer(const RectifiedCamera& camera, std::uint64_t seed)
      : camera_(camera), seed_(seed) {}

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override;

 private:
  RectifiedCamera camera_;
  std::uint64_t seed_;
  std::optional<InitializationFrame> reference_;
  ImageMotion motion_;  // motion from the reference to the newest frame
};

// Two-view initialization (SolveTwoViews) on the matches of rank1: points are tracked and aligned
// on the images (InitializationWindow), and the reference stays until its matches become too few.
// The comparison with rank1 isolates the effect of factorization and multi-frame decision, the
// comparison with two_view that of the matches.
//
// Each frame is tried by itself, with all its points of the reference. Needs the images of all
// frames (BugError otherwise).
class TwoViewImagesInitializer : public Initializer {
 public:
  TwoViewImagesInitializer(const CameraAndPyramid& imaging,
                           std::uint64_t seed,
                           HelperThread* helper = nullptr)
      : camera_(imaging.camera), seed_(seed), window_(imaging, InitialMatching::kImages, helper) {}

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override { window_.Reset(); }

 private:
  RectifiedCamera camera_;
  std::uint64_t seed_;
  InitializationWindow window_;
};

}  // namespace plumbline
