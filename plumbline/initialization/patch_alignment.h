// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/image/image.h"
#include "plumbline/initialization/klt_tracks.h"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace plumbline {

struct PatchAlignmentOptions {
  int radius = 5;  // half the width of the patch, in pixels of the feature's octave
  int max_iterations = 15;
  // Largest distance of each of the two searches from its start, in pixels of the octave. The
  // search by shifts starts at the guess, the search of the affine map at its result.
  double max_shift_px = 1.5;
  double min_correlation = 0.8;  // least final normalized correlation of the two patches
  // Least ratio of the smaller to the larger eigenvalue of the patch's structure tensor. Below it
  // the patch is an edge, and its position along the edge is undetermined.
  double min_roundness = 0.15;
  // Expected difference between the affine map of a patch and that of the whole image: standard
  // deviation of each entry of their quotient.
  double warp_sigma = 0.05;
  double octave_scale = 1.2;  // scale from one octave of the features to the next
};

// Finds the exact position in the later image of the reference's features. Corners detected in two
// images are not quite the same point of the scene, and corners at occlusion borders, or on an
// edge, slide along it.
//
// The patch around the feature of the reference, warped by `linear`, is shifted until it fits that
// of the later image, apart from brightness and contrast (Lucas and Kanade 1981, in the inverse
// form of Baker and Matthews 2004: gradients are those of the patch). From there its affine map is
// estimated together with the shift, since each surface rotates, shrinks and shears in its own way.
// A corner says little about some parts of the map; the prior `warp_sigma` is weighted against the
// residual.
//
//   guesses  predicted pixel of each feature of the reference; nullopt: not searched
//   linear   derivative of the motion from reference to image pixels
//   warps    one for each feature: the affine map of its patch is `linear` times this. Its input is
//            the start of the search, for instance that of the previous frame, its output the
//            result
//   returns  the pixel in `image` for each feature; nullopt if the patch is an edge, leaves an
//            image, ends too far from the guess or differs in appearance there
//   cost     some ten microseconds a feature
TrackedPixels AlignPatches(const GrayImage& reference_image,
                           std::span<const PointFeature> reference,
                           const GrayImage& image,
                           std::span<const std::optional<Eigen::Vector2d>> guesses,
                           const Eigen::Matrix2d& linear,
                           std::span<Eigen::Matrix2d> warps,
                           const PatchAlignmentOptions& options = {});

}  // namespace plumbline
