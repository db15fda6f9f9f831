// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/patch_alignment.h"

#include "plumbline/base/elementary.h"
#include "plumbline/features/image_patch.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/symmetric_matrix.h"

#include <cmath>
#include <cstddef>
#include <optional>

namespace plumbline {
namespace {

// A step is small enough below this, in pixels of the octave.
constexpr double kConverged = 0.01;

// Returns the patch of the reference around a pixel, in steps of its octave.
std::optional<ImagePatch> PatchAround(const GrayImage& image,
                                      const Eigen::Vector2d& px,
                                      double step,
                                      int radius) {
  const auto wide = SamplePatch(image, px, step * Eigen::Matrix2d::Identity(), radius + 1);
  return wide ? MakePatch(*wide, radius) : std::nullopt;
}

// Returns the derivatives of the normalized patch by a shift and by the columns of a linear map of
// its grid, in units of its radius. Their part along the patch itself is taken out, since contrast
// is not motion.
Eigen::Matrix<double, Eigen::Dynamic, 6> AffineDerivatives(const ImagePatch& patch, int radius) {
  Eigen::Matrix<double, Eigen::Dynamic, 6> J(patch.samples.size(), 6);
  Eigen::Index row = 0;
  for (int v = -radius; v <= radius; ++v) {
    for (int u = -radius; u <= radius; ++u, ++row) {
      const Eigen::RowVector2d gradient = patch.gradient.row(row);
      J.row(row) << gradient, gradient * u / radius, gradient * v / radius;
    }
  }
  J.rowwise() -= J.colwise().mean().eval();
  const Eigen::Matrix<double, 1, 6> along = patch.samples.matrix().transpose() * J;
  J -= patch.samples.matrix() * along;
  return J;
}

// Returns the position near `start`, the result of the search by shifts, at which the image matches
// the patch under an affine map: `axes` times `warp`. `warp` is the start of the search and returns
// the result. The prior of the warp has the weight of the residual. It keeps the warp near one
// while the patch does not fit and in directions that the patch does not determine.
std::optional<Eigen::Vector2d> AlignAffine(const ImagePatch& patch,
                                           const GrayImage& image,
                                           const Eigen::Vector2d& start,
                                           const Eigen::Matrix2d& axes,
                                           const PatchAlignmentOptions& options,
                                           Eigen::Matrix2d& warp) {
  // A step of the warp is small enough below this, in pixels at the patch's border.
  constexpr double kConvergedMap = 0.05;
  const int r = options.radius;
  const double sigma = options.warp_sigma * r;
  const auto J = AffineDerivatives(patch, r);
  const Matrix6d JJ = J.transpose() * J;
  const auto count = static_cast<double>(J.rows());
  const Eigen::Matrix2d inverse_axes = axes.inverse();
  Eigen::Vector2d px = start;
  Eigen::Matrix2d map = warp;
  for (int i = 0; i < options.max_iterations; ++i) {
    auto seen = SamplePatch(image, px, axes * map, r);
    if (!seen || !NormalizePatch(*seen)) return std::nullopt;
    const double correlation = (*seen * patch.samples).sum();
    const Eigen::VectorXd residual = (*seen - patch.samples).matrix();
    const double weight = residual.squaredNorm() / (count * sigma * sigma);
    const Eigen::Matrix2d off = (map - Eigen::Matrix2d::Identity()) * r;
    Matrix6d H = JJ;
    H.diagonal().tail<4>().array() += weight;
    Vector6d right = J.transpose() * residual;
    right.tail<4>() += weight * Eigen::Map<const Eigen::Vector4d>(off.data());
    const Vector6d step = SolveSymmetric<6>(H, right);
    const Eigen::Vector4d linear = step.tail<4>() / r;
    const Eigen::Matrix2d change =
        Eigen::Matrix2d::Identity() + Eigen::Map<const Eigen::Matrix2d>(linear.data());
    map = map * change.inverse();
    px -= axes * map * step.head<2>();
    if (!((inverse_axes * (px - start)).norm() <= options.max_shift_px)) return std::nullopt;
    if (step.head<2>().norm() > kConverged || step.tail<4>().norm() > kConvergedMap) continue;
    if (correlation < options.min_correlation) return std::nullopt;
    warp = map;
    return px;
  }
  return std::nullopt;
}

}  // namespace

TrackedPixels AlignPatches(const GrayImage& reference_image,
                           std::span<const PointFeature> reference,
                           const GrayImage& image,
                           std::span<const std::optional<Eigen::Vector2d>> guesses,
                           const Eigen::Matrix2d& linear,
                           std::span<Eigen::Matrix2d> warps,
                           const PatchAlignmentOptions& options) {
  const PatchShiftLimits shift{
      options.max_iterations, options.max_shift_px, options.min_correlation};
  TrackedPixels places(guesses.size());
  for (std::size_t k = 0; k < guesses.size(); ++k) {
    if (!guesses[k]) continue;
    const double step = math::Pow(options.octave_scale, reference[k].octave);
    const auto patch = PatchAround(reference_image, reference[k].px, step, options.radius);
    if (!patch || !patch->IsRound(options.min_roundness)) continue;
    const Eigen::Matrix2d axes = step * linear;
    const auto shifted = AlignShift(*patch, image, *guesses[k], axes * warps[k], shift);
    if (shifted) places[k] = AlignAffine(*patch, image, shifted->px, axes, options, warps[k]);
    if (!places[k]) warps[k].setIdentity();
  }
  return places;
}

}  // namespace plumbline
