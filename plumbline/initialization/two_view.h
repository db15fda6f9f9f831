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

// Returns how well a model of two views explains matches (Mur-Artal, Montiel and Tardos,
// "ORB-SLAM", 2015, section IV). This is the sum of 5.99 - d^2 over both images of all matches,
// where d is the distance over its deviation. d^2 counts below 3.84 for the distance from the
// epipolar line, and below 5.99 for the distance from the mapped point.
double EpipolarScore(const Eigen::Matrix3d& essential, std::span<const RayMatch> matches);
double TransferScore(const Eigen::Matrix3d& homography, std::span<const RayMatch> matches);

enum class TwoViewModel { kEssential, kHomography };

struct TwoViewSolution {
  InitializationStatus wait = InitializationStatus::kNone;  // kNone: the pose can be used
  TwoViewModel model = TwoViewModel::kEssential;
  // Pose with |translation| = 1. It is that of the best motion, even where the solution is not
  // good.
  Rigid3 b_from_a;
  // For each match, whether its point is in front of both views and agrees with both.
  std::vector<bool> is_good;
  // Median angle between the rays of good matches, without the rotation.
  double parallax_deg = 0;
};

// Decides on the relative pose as the ORB-SLAM paper does (section IV). Essential matrix and
// homography are found by RANSAC; the homography is chosen where its share of the two scores is
// above 0.45. Of all motions of the chosen model the one is taken with most points that lie in
// front and agree with both views, if it has enough of them, parallax, and no rival.
//
// Differs from the paper: the essential matrix takes the place of the fundamental matrix, since the
// camera is calibrated; the number of samples is adaptive, and the inliers are fitted by least
// squares (ransac.h).
//
//   fails  wait says why: kTooFewMatches, kAmbiguous (a rival with 0.75 of the points),
//          kTooLittleParallax (median below 1 degree), kInaccurate (too few good points)
//   cost   some milliseconds
TwoViewSolution SolveTwoViews(std::span<const RayMatch> matches, Rng& rng);

// The conventional start: the first frame with enough features is the reference until a later one
// gives a pose (SolveTwoViews) and a map after bundle adjustment. A frame with too few matches
// becomes the new reference, and earlier frames are forgotten.
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

// The conventional decision (SolveTwoViews) on the matches of rank1: points are followed and
// aligned on the images (InitializationWindow), and the reference stays until matches with it die
// out. The comparison with rank1 shows what factorization and the decision of several frames bring,
// the comparison with two_view what the matches bring.
//
// Each frame is tried by itself, with all points of the reference that it shows. Needs the images
// of all frames (BugError otherwise).
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
