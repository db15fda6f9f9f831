// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/image/image.h"
#include "plumbline/initialization/klt_tracks.h"

#include <span>

#include <Eigen/Core>

namespace plumbline {

struct PatchAlignmentOptions {
  int radius = 5;  // half the width of the patch, in pixels of the feature's octave
  int max_iterations = 15;
  // How far each of the two steps may go from where it begins, in pixels of the octave: shifts
  // alone begin at the guess, the affine map where these end.
  double max_shift_px = 1.5;
  double min_correlation = 0.8;  // least normalized correlation of the two patches in the end
  // Smaller over larger eigenvalue of the patch's structure tensor; below, it is an edge and the
  // place along it is free.
  double min_roundness = 0.15;
  // How far the affine map of a patch is expected to be from that of the whole image: standard
  // deviation of each entry of their quotient.
  double warp_sigma = 0.05;
};

// Where the later image shows exactly what the reference shows around a feature: the corners that a
// detector finds in two images are not quite the same point of the scene, and those at the border
// of a thing before another, or on an edge, slide along it.
//
// The patch around the feature of the reference, warped by `linear`, is shifted until it fits that
// of the later image, brightness and contrast apart (Lucas and Kanade 1981, in the inverse form of
// Baker and Matthews 2004: gradients are those of the patch). From there its affine map is found
// together with the shift, since surfaces turn, shrink and shear each in its own way. A corner says
// little about some of the map: the prior `warp_sigma` is weighed against the residual left.
//
//   guesses  by feature of the reference, where the image should show it; nullopt: not looked for
//   linear   derivative of the motion from reference to image pixels
//   warps    by feature, a factor: the affine map of its patch is `linear` times this. It goes in
//            as the start of the search, for instance that of the frame before, and comes out as
//            found
//   returns  by feature, the pixel in `image`; nullopt where the patch is an edge, leaves an image,
//            ends too far from the guess or does not look the same there
//   cost     some ten microseconds a feature
TrackedPixels AlignPatches(const GrayImage& reference_image,
                           std::span<const PointFeature> reference,
                           const GrayImage& image,
                           const TrackedPixels& guesses,
                           const Eigen::Matrix2d& linear,
                           std::span<Eigen::Matrix2d> warps,
                           const PatchAlignmentOptions& options = {});

}  // namespace plumbline
