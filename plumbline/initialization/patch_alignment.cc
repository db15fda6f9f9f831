// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/patch_alignment.h"

#include "plumbline/base/elementary.h"
#include "plumbline/geometry/eigenpairs.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/symmetric_system.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

constexpr double kOctave = 1.2;      // from one octave to the next
constexpr double kConverged = 0.01;  // of a step, in pixels of the octave

// Samples of an image around a pixel on a regular grid, row after row.
using Samples = Eigen::ArrayXd;

// nullopt where a sample lies outside. `axes` has a step along u and v in its columns.
std::optional<Samples> Sample(const GrayImage& image,
                              const Eigen::Vector2d& centre,
                              const Eigen::Matrix2d& axes,
                              int radius) {
  const Eigen::Vector2d reach = radius * axes.cwiseAbs().rowwise().sum();
  if (!((centre - reach).minCoeff() >= 0) || !(centre.x() + reach.x() < image.width() - 1) ||
      !(centre.y() + reach.y() < image.height() - 1)) {
    return std::nullopt;
  }
  const int side = 2 * radius + 1;
  Samples samples(side * side);
  Eigen::Index next = 0;
  for (int v = -radius; v <= radius; ++v) {
    for (int u = -radius; u <= radius; ++u) {
      const Eigen::Vector2d px = centre + axes * Eigen::Vector2d(u, v);
      const int x = static_cast<int>(px.x());
      const int y = static_cast<int>(px.y());
      const double fx = px.x() - x;
      const double fy = px.y() - y;
      const std::uint8_t* row = image.row(y) + x;
      const std::uint8_t* below = image.row(y + 1) + x;
      samples(next++) =
          (1 - fy) * ((1 - fx) * row[0] + fx * row[1]) + fy * ((1 - fx) * below[0] + fx * below[1]);
    }
  }
  return samples;
}

// Mean zero, length one; false where nothing is to be seen.
bool Normalize(Samples& samples) {
  samples -= samples.mean();
  const double length = samples.matrix().norm();
  if (!(length > std::sqrt(static_cast<double>(samples.size())))) return false;
  samples /= length;
  return true;
}

// A patch of the reference, normalized, with its derivatives along u and v.
struct Patch {
  Samples samples;
  Eigen::Matrix<double, Eigen::Dynamic, 2> gradient;
  Eigen::Matrix2d tensor;  // of the gradients, their mean taken off

  bool IsRound(double min_roundness) const {
    const Eigen::Vector2d values = EigenvaluesOf<2>(tensor);
    return values(0) > min_roundness * values(1);
  }
};

std::optional<Patch> PatchAround(const GrayImage& image,
                                 const Eigen::Vector2d& px,
                                 double step,
                                 int radius) {
  const auto wide = Sample(image, px, step * Eigen::Matrix2d::Identity(), radius + 1);
  if (!wide) return std::nullopt;
  const int side = 2 * radius + 1;
  Patch patch{Samples(side * side), {}, {}};
  patch.gradient.resize(side * side, 2);
  Eigen::Index next = 0;
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u, ++next) {
      const Eigen::Index at = static_cast<Eigen::Index>(v + 1) * (side + 2) + u + 1;
      patch.samples(next) = (*wide)(at);
      patch.gradient(next, 0) = ((*wide)(at + 1) - (*wide)(at - 1)) / 2;
      patch.gradient(next, 1) = ((*wide)(at + side + 2) - (*wide)(at - side - 2)) / 2;
    }
  }
  patch.samples -= patch.samples.mean();
  const double length = patch.samples.matrix().norm();
  Samples normalized = patch.samples;
  if (!Normalize(normalized)) return std::nullopt;
  patch.samples = normalized;
  patch.gradient /= length;
  const auto centred = (patch.gradient.rowwise() - patch.gradient.colwise().mean()).eval();
  patch.tensor = centred.transpose() * centred;
  return patch;
}

// Derivatives of the normalized patch by a shift and by the columns of a linear map of its grid, in
// units of its radius. Its own direction is taken out: contrast is not what moves.
Eigen::Matrix<double, Eigen::Dynamic, 6> AffineDerivatives(const Patch& patch, int radius) {
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

// The place near `start`, found by shifts alone, where the image looks like the patch under an
// affine map of its own, `axes` times `warp`, which begins at what it is. The prior of the warp has
// the weight of the residual: it holds the warp near one while the patch does not fit and where it
// says nothing.
std::optional<Eigen::Vector2d> AlignAffine(const Patch& patch,
                                           const GrayImage& image,
                                           const Eigen::Vector2d& start,
                                           const Eigen::Matrix2d& axes,
                                           const PatchAlignmentOptions& options,
                                           Eigen::Matrix2d& warp) {
  constexpr double kConvergedMap = 0.05;  // of a step, in pixels at the patch's border
  const int r = options.radius;
  const double sigma = options.warp_sigma * r;
  const auto J = AffineDerivatives(patch, r);
  const Matrix6d JJ = J.transpose() * J;
  const auto count = static_cast<double>(J.rows());
  const Eigen::Matrix2d inverse_axes = axes.inverse();
  Eigen::Vector2d px = start;
  Eigen::Matrix2d map = warp;
  for (int i = 0; i < options.max_iterations; ++i) {
    auto seen = Sample(image, px, axes * map, r);
    if (!seen || !Normalize(*seen)) return std::nullopt;
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

// The place near `start` where the image looks like the patch under the map `axes`.
std::optional<Eigen::Vector2d> AlignShift(const Patch& patch,
                                          const GrayImage& image,
                                          const Eigen::Vector2d& start,
                                          const Eigen::Matrix2d& axes,
                                          const PatchAlignmentOptions& options) {
  const Eigen::LDLT<Eigen::Matrix2d> tensor(patch.tensor);
  const Eigen::Matrix2d inverse_axes = axes.inverse();
  Eigen::Vector2d px = start;
  for (int i = 0; i < options.max_iterations; ++i) {
    auto seen = Sample(image, px, axes, options.radius);
    if (!seen || !Normalize(*seen)) return std::nullopt;
    const double correlation = (*seen * patch.samples).sum();
    const Eigen::Vector2d step =
        tensor.solve(patch.gradient.transpose() * (*seen - patch.samples).matrix());
    px -= axes * step;
    if ((inverse_axes * (px - start)).norm() > options.max_shift_px) return std::nullopt;
    if (step.norm() > kConverged) continue;
    if (correlation < options.min_correlation) return std::nullopt;
    return px;
  }
  return std::nullopt;
}

}  // namespace

TrackedPixels AlignPatches(const GrayImage& reference_image,
                           std::span<const PointFeature> reference,
                           const GrayImage& image,
                           const TrackedPixels& guesses,
                           const Eigen::Matrix2d& linear,
                           std::span<Eigen::Matrix2d> warps,
                           const PatchAlignmentOptions& options) {
  TrackedPixels places(guesses.size());
  for (std::size_t k = 0; k < guesses.size(); ++k) {
    if (!guesses[k]) continue;
    const double step = math::Pow(kOctave, reference[k].octave);
    const auto patch = PatchAround(reference_image, reference[k].px, step, options.radius);
    if (!patch || !patch->IsRound(options.min_roundness)) continue;
    const Eigen::Matrix2d axes = step * linear;
    const auto shifted = AlignShift(*patch, image, *guesses[k], axes * warps[k], options);
    if (shifted) places[k] = AlignAffine(*patch, image, *shifted, axes, options, warps[k]);
    if (!places[k]) warps[k].setIdentity();
  }
  return places;
}

}  // namespace plumbline
