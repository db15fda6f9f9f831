// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// Samples of an image around a pixel on a regular square grid, row after row.
using PatchSamples = Eigen::ArrayXd;

// Takes samples by bilinear interpolation at `centre` + `axes` (u, v), with u and v from -radius to
// radius. Returns nullopt where a sample lies outside of the image.
std::optional<PatchSamples> SamplePatch(const GrayImage& image,
                                        const Eigen::Vector2d& centre,
                                        const Eigen::Matrix2d& axes,
                                        int radius);

// Subtracts the mean and scales to the length one. Returns false where nothing is to be seen: the
// grey levels differ by less than one.
bool NormalizePatch(PatchSamples& samples);

// What a reference shows around a pixel, to be found again in another image: normalized samples
// with their derivatives along u and v.
struct ImagePatch {
  int radius = 0;
  PatchSamples samples;
  Eigen::Matrix<double, Eigen::Dynamic, 2> gradient;
  // Structure tensor of the gradients, without their mean.
  Eigen::Matrix2d tensor;

  // Whether the smaller eigenvalue of the tensor is more than this part of the larger one. Where it
  // is not, the patch is an edge, along which its place is free.
  bool IsRound(double min_roundness) const;
};

// Makes a patch of samples of a grid that is wider by one on each side, which derivatives need.
// Returns nullopt where nothing is to be seen.
std::optional<ImagePatch> MakePatch(const PatchSamples& wide, int radius);

struct PatchShiftLimits {
  int max_iterations = 15;
  // Largest distance from where the search begins, in steps of the grid.
  double max_shift_px = 1.5;
  double min_correlation = 0.8;  // least normalized correlation of the two patches in the end
  // The search ends at a step that is shorter than this, in steps of the grid.
  double converged_px = 0.01;
};

// Where a patch was found in another image.
struct PatchPlace {
  Eigen::Vector2d px;
  // Shift from where the search began, in steps of the grid.
  Eigen::Vector2d shift;
  // Covariance of the shift, as far as the residuals of the samples tell it.
  Eigen::Matrix2d covariance;
};

// Finds the place near `start` where the image looks like the patch under the map `axes` of its
// grid, apart from brightness and contrast (Lucas and Kanade 1981, in the inverse form of Baker and
// Matthews 2004: gradients are those of the patch). The covariance is the variance of the residuals
// times the inverse of the tensor. It does not include errors that all samples have in common, such
// as a wrong map of the grid. Returns nullopt where the search leaves the image or the limits, or
// does not end. Cost: some ten microseconds at a radius of 5.
std::optional<PatchPlace> AlignShift(const ImagePatch& patch,
                                     const GrayImage& image,
                                     const Eigen::Vector2d& start,
                                     const Eigen::Matrix2d& axes,
                                     const PatchShiftLimits& limits);

}  // namespace plumbline
