// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// Samples of an image around a pixel on a regular square grid, row after row.
using PatchSamples = Eigen::ArrayXd;

// Samples by bilinear interpolation at `centre` + `axes` (u, v), u and v from -radius to radius.
// nullopt where one lies outside of the image.
std::optional<PatchSamples> SamplePatch(const GrayImage& image,
                                        const Eigen::Vector2d& centre,
                                        const Eigen::Matrix2d& axes,
                                        int radius);

// Takes off the mean and scales to the length one. Returns false where nothing is to be seen: the
// grey levels differ by less than one.
bool NormalizePatch(PatchSamples& samples);

// What a reference shows around a pixel, to be found again in another image: samples, normalized,
// with their derivatives along u and v.
struct ImagePatch {
  int radius = 0;
  PatchSamples samples;
  Eigen::Matrix<double, Eigen::Dynamic, 2> gradient;
  Eigen::Matrix2d tensor;  // of the gradients, their mean taken off

  // Whether the smaller eigenvalue of the tensor is more than this part of the larger one. Where it
  // is not, the patch is an edge, along which its place is free.
  bool IsRound(double min_roundness) const;
};

// The patch of the samples of a grid that is wider by one on each side, for the derivatives;
// nullopt where nothing is to be seen.
std::optional<ImagePatch> MakePatch(const PatchSamples& wide, int radius);

struct PatchShiftLimits {
  int max_iterations = 15;
  double max_shift_px = 1.5;     // from where the search begins, in steps of the grid
  double min_correlation = 0.8;  // least normalized correlation of the two patches in the end
  double converged_px = 0.01;    // the search ends at a step that is shorter, in steps of the grid
};

// Where a patch was found in another image.
struct PatchPlace {
  Eigen::Vector2d px;
  Eigen::Vector2d shift;       // from where the search began, in steps of the grid
  Eigen::Matrix2d covariance;  // of the shift, as far as the residuals of the samples tell
};

// Finds the place near `start` where the image looks like the patch under the map `axes` of its
// grid, brightness and contrast apart (Lucas and Kanade 1981, in the inverse form of Baker and
// Matthews 2004: gradients are those of the patch). The covariance is the variance of the residuals
// times the inverse of the tensor; what all samples have in common, as a wrong map of the grid, it
// does not know. nullopt where the search leaves the image or the limits, or does not end. Cost:
// some ten microseconds at a radius of 5.
std::optional<PatchPlace> AlignShift(const ImagePatch& patch,
                                     const GrayImage& image,
                                     const Eigen::Vector2d& start,
                                     const Eigen::Matrix2d& axes,
                                     const PatchShiftLimits& limits);

}  // namespace plumbline
