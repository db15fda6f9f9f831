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
// radius. Returns nullopt if a sample lies outside of the image.
std::optional<PatchSamples> SamplePatch(const GrayImage& image,
                                        const Eigen::Vector2d& centre,
                                        const Eigen::Matrix2d& axes,
                                        int radius);

// Subtracts the mean and scales to length one. Returns false for a patch without texture: its grey
// levels differ by less than one.
bool NormalizePatch(PatchSamples& samples);

// Reference patch around a pixel, for search in another image: normalized samples with their
// derivatives along u and v.
struct ImagePatch {
  int radius = 0;
  PatchSamples samples;
  Eigen::Matrix<double, Eigen::Dynamic, 2> gradient;
  // Structure tensor of the gradients, mean removed.
  Eigen::Matrix2d tensor;

  // Returns true if the smaller eigenvalue of the tensor exceeds this fraction of the larger one.
  // Otherwise the patch is an edge, whose position along the edge is undetermined.
  bool IsRound(double min_roundness) const;
};

// Makes a patch from a sample grid that is wider by one on each side, for the derivatives. Returns
// nullopt for a patch without texture.
std::optional<ImagePatch> MakePatch(const PatchSamples& wide, int radius);

struct PatchShiftLimits {
  int max_iterations = 15;
  // Largest distance from the start of the search, in steps of the grid.
  double max_shift_px = 1.5;
  double min_correlation = 0.8;  // least normalized correlation of the two patches at the end
  // The search converges at a step shorter than this, in steps of the grid.
  double converged_px = 0.01;
};

// Position of a patch in another image.
struct PatchPlace {
  Eigen::Vector2d px;
  // Shift from the start of the search, in steps of the grid.
  Eigen::Vector2d shift;
  // Covariance of the shift, from the residuals of the samples.
  Eigen::Matrix2d covariance;
};

// Finds the position near `start` whose surroundings match the patch under the map `axes` of its
// grid, up to brightness and contrast (Lucas and Kanade 1981, in the inverse compositional form of
// Baker and Matthews 2004: gradients are those of the patch). The covariance is the variance of the
// residuals times the inverse of the tensor. It does not include errors common to all samples, such
// as a wrong map of the grid. Returns nullopt if the search leaves the image or the limits, or does
// not converge. Cost: some ten microseconds at a radius of 5.
std::optional<PatchPlace> AlignShift(const ImagePatch& patch,
                                     const GrayImage& image,
                                     const Eigen::Vector2d& start,
                                     const Eigen::Matrix2d& axes,
                                     const PatchShiftLimits& limits);

}  // namespace plumbline
